// A robot's log as it grows: keyframes, and what was measured from them.
//
// Odometry comes sample by sample, measurements whenever they are known. What lies before the last sample is
// final: which keyframes there are, and from which a measurement is said. The records are the same however
// late a measurement came, as long as what lies at its time was not final. Where the odometry at its time is
// forgotten, it is said from the geodesic between two keyframes.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "radioslam/mission/keyframe_choice.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/records/record.hpp"

namespace radioslam {

class LogBuilder {
 public:
  /// Keeps references. `names`: anchors, access points and the other robots. `robot` has the odometry that
  /// was added, at least from the last keyframe that was said, and the noise of its steps; if it comes with
  /// keyframes, none are chosen.
  LogBuilder(const Mission& names, const Robot& robot, const KeyframeParams& params);
  LogBuilder(const LogBuilder&) = delete;
  LogBuilder& operator=(const LogBuilder&) = delete;

  /// The next sample of the odometry.
  void add(const StampedPose<SE3>& odometry);
  /// A keyframe, by the robot's choice.
  void add_keyframe(Stamp stamp) { add(Occasion{stamp, 0, 0}); }
  /// A measurement of robot `self`; of another robot's to this one, only its time matters.
  void add(const RangeMeasurement& range, RobotIndex self);
  void add(const AoaMeasurement& angles);
  void add(const PositionFix& fix);
  void add(const WifiScan& scan);
  /// A relative pose that was recorded, known when both of its ends are.
  void add(const PoseMatch& match, RobotIndex self);
  /// What is measured at `stamp` and known later; `record` without its pose.
  void add(Stamp stamp, Stamp known, ClosureRecord record);
  void add(Stamp stamp, DescriptorRecord record);
  /// An occasion for a keyframe.
  void add(const Occasion& occasion);

  /// Says a record that has no place in time; one that is not valid is left out.
  void say(const Record& record);

  /// No more comes: the last sample is a keyframe.
  void finish();

  /// Says the motion between keyframes again, where this odometry, in the same frame, has another.
  void amend(const Trajectory<SE3>& odometry, const OdometryNoise& noise);

  /// Records since the last call, encoded; facts and anchors first.
  std::vector<std::string> take();
  /// The keyframes that were said, in the frame of the odometry.
  const std::vector<StampedPose<SE3>>& said() const { return said_; }
  /// Measurements outside the odometry, or too late, or beyond what a record holds.
  std::size_t left_out() const { return left_out_; }

 private:
  using Measured = std::variant<Record, WifiScan>;
  struct Waiting {
    Stamp known;
    Measured measured;
  };

  void wait(Stamp stamp, Stamp known, Measured measured);
  void settle();
  void place(Stamp stamp, std::size_t order, Waiting waiting);
  bool set_pose(Stamp stamp, Record& record) const;
  std::optional<PoseAt> at(Stamp stamp) const;
  const std::vector<Stamp>& keyframes() const;
  bool is_final(Stamp stamp) const { return is_finished_ || (last_sample_ && stamp < *last_sample_); }
  LinkPeer peer(const LinkEnd& end) const;
  void place_fingerprint(const WifiScan& scan, Stamp known, std::size_t order);
  void say_keyframes(const std::function<bool(Stamp)>& until);

  const Mission& names_;
  const Robot& robot_;
  KeyframeChoice choice_;
  std::optional<Stamp> last_sample_;
  std::size_t counter_ = 0;
  std::multimap<Stamp, Occasion> occasions_;                     ///< after the last sample, or at it
  std::map<std::pair<Stamp, std::size_t>, Waiting> waiting_;     ///< by stamp, then as they came
  std::multimap<std::pair<Stamp, std::size_t>, Record> placed_;  ///< by the time they are known
  std::vector<StampedPose<SE3>> said_;
  std::map<std::pair<AccessPointIndex, float>, std::uint32_t> numbers_;  ///< of access points
  std::vector<std::string> records_;
  std::size_t left_out_ = 0;
  bool is_finished_ = false;
};

}  // namespace radioslam

// A robot's front end: samples of its sensors in; its log, its pose, and what happened out.
//
//   order     samples wait until none that is at most kLate_s late can come before them; later ones are left
//             out, counted and named
//   scans     are tracked with what else moves with them (odometry/scan_front_end.hpp); without a scanner the
//             recorded odometry is the robot's
//   log       keyframes and what was measured from them, as they become final (records/log_builder.hpp)
//   amend     what the robot changes its mind about: an IMU that turns out to agree or not, the motion
//   smoothed
//             with it, at the end all that hindsight makes of it
// Causal, and the same however the samples are ordered within kLate_s.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_front_end.hpp"
#include "radioslam/records/log_builder.hpp"
#include "radioslam/records/resumed_log.hpp"

namespace radioslam {

struct ScanSample {
  Stamp stamp;
  LidarScan scan;
};

/// In the order in which samples of one stamp are taken.
using Sample = std::variant<StampedPose<SE3>, ImuSample, ScanSample, RangeMeasurement, AoaMeasurement,
                            PositionFix, WifiScan, PoseMatch>;
inline constexpr std::array kSampleNames{"odometry rows", "IMU samples", "scans",      "ranges",
                                         "angles",        "fixes",       "WiFi scans", "matches"};

/// When it is known.
Stamp stamp_of(const Sample& sample);

/// A registered scan or, of a robot without scans, a row of its odometry; as known when it was added.
struct OnlinePose {
  Stamp stamp;
  SE3 T_start_body;
};

class FrontEnd {
 public:
  static constexpr double kLate_s = 0.3;

  /// Of robot `self`. `names`: its properties, anchors, access points and the other robots; its recordings
  /// are not read. Keeps references.
  FrontEnd(const Mission& names, RobotIndex self, MotionSources sources, const ScanParams& scans,
           const KeyframeParams& keyframes, CloudStore& clouds);
  FrontEnd(const FrontEnd&) = delete;
  FrontEnd& operator=(const FrontEnd&) = delete;

  /// In any order within kLate_s.
  void add(Sample sample);

  /// No more samples come. The scans' trajectory with hindsight; without scans, nothing.
  std::optional<TrackedScans> finish();
  /// Says the motion between keyframes again (LogBuilder::amend).
  void amend(const MeasuredOdometry& odometry) { log_.amend(odometry.samples, odometry.noise); }

  /// Records since the last call, encoded.
  std::vector<std::string> take_records() { return log_.take(); }
  /// Poses since the last call, in time order.
  std::vector<OnlinePose> take_poses();
  /// In the frame of the odometry.
  std::optional<StampedPose<SE3>> latest() const { return latest_; }
  const std::vector<StampedPose<SE3>>& keyframes() const { return log_.said(); }
  /// Of a robot that follows its scans, as far as odometry is recorded beside them.
  const RecordedAtKeyframes& recorded_at_keyframes() const { return recorded_at_keyframes_; }
  /// Whether its poses are those of scans, and these.
  bool follows_scans() const { return follows_scans_; }
  const ScanFrontEnd& scans() const { return scans_; }
  /// So far, in time order.
  std::vector<FrontEndEvent> events() const;
  /// Measurements that no record says: outside the odometry, too late, or beyond what a record holds.
  std::size_t left_out() const { return log_.left_out() + late_; }

 private:
  void take(Sample sample);
  void follow_scans();
  void add_pose(Stamp stamp, const SE3& pose, const SE3::Jacobian* covariance);
  void add_pose_of(const ScanTrajectory& track, std::size_t k);
  void note_recorded();

  RobotIndex self_;
  ScanParams params_;
  KeyframeParams keyframe_params_;
  std::map<std::tuple<Stamp, std::size_t, std::size_t>, Sample> waiting_;  ///< by stamp, kind, order
  std::size_t counter_ = 0, late_ = 0;
  std::optional<Stamp> newest_, released_;
  bool follows_scans_;
  SensorHistory history_;  ///< its odometry: the robot's, as it is said
  ScanFrontEnd scans_;
  LogBuilder log_;
  std::optional<StampedPose<SE3>> latest_;
  std::deque<StampedPose<SE3>> recorded_;  ///< rows of odometry beside scans, since the last keyframe
  std::size_t noted_ = 0;                  ///< keyframes at which they were looked up
  RecordedAtKeyframes recorded_at_keyframes_;
  std::vector<OnlinePose> poses_;
  std::vector<FrontEndEvent> late_events_;
  std::array<bool, std::variant_size_v<Sample>> is_late_said_{};
};

}  // namespace radioslam

// A robot's log after its program was started again: what the new front end says, as more of the same log.
//
// Keyframes and access points are numbered on. The motion in between is what an odometry says that was not
// stopped: the robot's own, where its poses are those of the odometry, or the one that is recorded beside its
// scans. Else it is not known, and one keyframe is missing (mission_of_logs).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/records/record.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

/// Recorded odometry at keyframes of a robot that follows its scans: T_odometry_body by their stamps.
using RecordedAtKeyframes = std::map<Stamp, SE3>;

/// One of them as bytes, for a journal, and read again; empty where it is none.
std::string encode_recorded(const RecordedAtKeyframes::value_type& recorded);
RecordedAtKeyframes decode_recorded(const std::string& bytes);

/// The odometry beside the scans, in one frame before and after.
struct OdometryBesideScans {
  RecordedAtKeyframes before;        ///< at the log's last keyframe, if it is known
  const RecordedAtKeyframes& after;  ///< at the new front end's first one, once that is said
  OdometryNoise noise;
};

class ResumedLog {
 public:
  /// `before`: the log so far. `odometry_goes_on`: the poses of the new front end are in the frame in which
  /// the log was said.
  ResumedLog(const KnownLog& before, bool odometry_goes_on);
  /// Of a robot that follows its scans.
  ResumedLog(const KnownLog& before, OdometryBesideScans odometry);

  /// A record of the new front end as the log has it, encoded; nothing for what the log says already.
  std::optional<std::string> continued(const std::string& record);

 private:
  void add_usual(const KeyframeRecord& keyframe);
  void connect(KeyframeRecord& first);
  OdometryEdge<SE3> crossing(const SE3& motion, Stamp end, OdometryNoise noise) const;

  bool odometry_goes_on_;
  std::optional<OdometryBesideScans> odometry_;
  std::uint32_t keyframes_ = 0, access_points_ = 0;           ///< numbers that are taken
  std::optional<StampedPose<SE3>> last_;                      ///< keyframe, by the odometry as it was said
  OdometryNoise noise_;                                       ///< as the log states it
  double travelled_m_ = 0, turned_rad_ = 0, followed_s_ = 0;  ///< by the log
};

}  // namespace radioslam

// Which estimated pose belongs to which true one.
//
// kInterpolate: the estimate at the truth's stamps, positions linearly and rotations along the shortest arc
// between the two estimated poses around the stamp; nothing is extrapolated. Waypoints (truth without
// orientation) are stamped by hand: one that lies up to kWaypointStampSlack_s before the first or after the
// last estimated pose is compared with that pose.
// kNearest: as in evo 1.x: for every pose of the shorter trajectory the nearest stamp of the longer one, kept
// when at most kNearestStampDifference_s away.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// How far a hand-pressed waypoint may lie outside the estimate's time.
inline constexpr double kWaypointStampSlack_s = 0.5;
/// evo's default for matching stamps.
inline constexpr double kNearestStampDifference_s = 0.01;

/// A true pose and the estimate of it.
struct MatchedPose {
  std::size_t truth_index = 0;  ///< into the truth's poses
  SE3 truth;
  SE3 estimate;
};

/// Position linear, rotation by slerp; nothing outside the trajectory's time.
std::optional<SE3> pose_at(const Trajectory<SE3>& trajectory, Stamp stamp);

/// As pose_at, but the first (last) pose also counts for `slack_s` before (after) it.
std::optional<SE3> pose_near(const Trajectory<SE3>& trajectory, Stamp stamp, double slack_s);

/// The pairs to compare, in time order.
std::vector<MatchedPose> match_poses(const Trajectory<SE3>& estimate, const RobotTruth& truth,
                                     Association association);

}  // namespace radioslam

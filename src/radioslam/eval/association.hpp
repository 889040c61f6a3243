// Associates estimated with true poses by their stamps.
//
// kInterpolate: the estimate at the truth's stamps, positions linearly and rotations along the shortest arc
// between the two estimated poses around the stamp, without extrapolation. Waypoints (truth without
// orientation) are stamped by hand: one up to kWaypointStampSlack_s before the first or after the last
// estimated pose is compared with that pose. kNearest: as in evo 1.x, for every pose of the shorter
// trajectory the nearest stamp of the longer one, if at most kNearestStampDifference_s away.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// Largest time by which a waypoint stamped by hand may be outside the estimate.
inline constexpr double kWaypointStampSlack_s = 0.5;
/// Default of evo for associating stamps.
inline constexpr double kNearestStampDifference_s = 0.01;

/// A true pose and its estimate.
struct MatchedPose {
  std::size_t truth_index = 0;  ///< into the truth's poses
  SE3 truth;
  SE3 estimate;
};

/// Pose with linear position and slerp rotation; nothing outside the trajectory's time.
std::optional<SE3> pose_at(const Trajectory<SE3>& trajectory, Stamp stamp);

/// As pose_at, but the first (last) pose is also returned up to `slack_s` before (after) it.
std::optional<SE3> pose_near(const Trajectory<SE3>& trajectory, Stamp stamp, double slack_s);

/// Associated poses, in time order.
std::vector<MatchedPose> match_poses(const Trajectory<SE3>& estimate, const RobotTruth& truth,
                                     Association association);

}  // namespace radioslam

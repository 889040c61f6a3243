// Replaces odometry by the poses of scans, with recorded odometry where there are no scans.
//
//   before, after   recorded samples, moved rigidly to join the first or last scan, with their stated noise
//   between scans   the scans' steps, each with its covariance spread evenly in time
//   in a gap        recorded samples, deformed according to their noise to join both scans, together as
//                   uncertain as the scans' step (mission/continuous_trajectory.hpp)
//
// The result stays in the frame of the recorded odometry, which known starts and compasses refer to: the
// first scan that it covers keeps its recorded pose, or only position and heading if gravity is known.
// Recorded samples before the first or after the last scan that do not connect to it in time are dropped.
// Cost: linear in scans and samples.
#pragma once

#include <cstddef>

#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_params.hpp"
#include "radioslam/odometry/scan_tracking.hpp"

namespace radioslam {

/// Number of recorded samples that replace_odometry would drop.
std::size_t unreachable_samples(const Trajectory<SE3>& recorded, const ScanTrajectory& track);

/// Replaces the robot's odometry and moves `track`, which has at least one pose, into its frame.
void replace_odometry(Robot& robot, ScanTrajectory& track, const ScanStageParams& params);

}  // namespace radioslam

// Odometry from the poses of scans, with recorded odometry where there are no scans.
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

/// Motion of a robot with the noise of every step.
struct MeasuredOdometry {
  Trajectory<SE3> samples;  ///< T_start_body
  OdometryNoise noise;
};

/// Number of recorded samples that odometry_from_scans would drop.
std::size_t unreachable_samples(const Trajectory<SE3>& recorded, const ScanTrajectory& track);

/// Moves `track`, which has at least one pose, into the frame of the robot's recorded odometry.
MeasuredOdometry odometry_from_scans(const Robot& robot, ScanTrajectory& track,
                                     const ScanStageParams& params);

}  // namespace radioslam

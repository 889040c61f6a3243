// The poses of a robot's scans as its odometry, with recorded rows where there are no scans.
//
//   before, after   recorded rows moved rigidly to meet the first or the last scan, their noise as stated
//   between scans   the step of the scans; its covariance is spread evenly in time
//   in a gap        recorded rows bent to meet both scans as their noise grew, and together as uncertain as
//                   the step of the scans (mission/continuous_trajectory.hpp)
//
// The frame is that of the recorded odometry, of which known starts and compasses speak: the first scan that
// it covers stays where it has it. Where gravity told which way is up, it gives place and heading alone.
// Recorded rows before the first scan or after the last that nothing ties to it are lost.
// Cost: linear in scans and rows.
#pragma once

#include <cstddef>

#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/scan_params.hpp"
#include "radioslam/pipeline/scan_track.hpp"

namespace radioslam {

/// How many recorded rows take_odometry would lose.
std::size_t rows_out_of_reach(const Trajectory<SE3>& recorded, const ScanTrack& track);

/// Gives the robot the odometry; moves the track, which has a pose at least, into its frame.
void take_odometry(Robot& robot, ScanTrack& track, const ScanStageParams& params);

}  // namespace radioslam

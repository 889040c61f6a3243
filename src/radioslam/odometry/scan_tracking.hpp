// Registers one robot's scans in sequence (lidar/lidar_odometry.hpp) and selects keyframes with their clouds.
//
// The motion prior comes from the first of these that covers the time since the previous scan:
//   IMU                  if enabled by `by`                      (imu_motion_prior.hpp)
//   recorded odometry
//   constant velocity
// The same source deskews the scan, recorded odometry only if its samples are as frequent as the scans
// (imu_motion_prior.hpp); the remaining distortion is part of each step's covariance (motion_distortion.hpp).
// Scans that do not match the map, or have too few points, are counted and skipped. If the scans after the
// first do not match it, the trajectory starts with the new map instead.
// Cost: the scans' registrations; only the keyframes' clouds are kept.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_params.hpp"
#include "radioslam/places/loops/scan_loops.hpp"

namespace radioslam {

struct ScanTrajectory {
  ScanPoses poses;  ///< of the registered scans, without their clouds
  std::vector<std::size_t> keyframes;
  std::vector<StoredCloud> clouds;  ///< of the keyframes
  std::map<ScanStatus, std::size_t> status_counts;
  PointCounts points;
  double nominal_inlier_ratio = 0;
  bool is_level = false;  ///< roll and pitch are aligned with gravity
};

/// The keyframes for loop closing.
ScanKeyframes extract_keyframes(const ScanTrajectory& track, const ScannerTraits& traits);

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

/// Motion of a robot with the noise of every step.
struct MeasuredOdometry {
  Trajectory<SE3> samples;  ///< T_start_body
  OdometryNoise noise;
};

/// Number of recorded samples that odometry_from_scans would drop.
std::size_t unreachable_samples(const Trajectory<SE3>& recorded, const ScanTrajectory& track);

/// `track` has at least one pose. The result is in the frame of the robot's recorded odometry.
MeasuredOdometry odometry_from_scans(const Robot& robot, const ScanTrajectory& track,
                                     const ScanStageParams& params);

}  // namespace radioslam

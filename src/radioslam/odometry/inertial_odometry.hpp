// LiDAR-inertial odometry: smooths a robot's registered scans together with its IMU samples.
//
// The smoother (inertial/inertial_smoother.hpp) estimates all states at once. A scan contributes the
// information of its points, which is none along a featureless corridor; the map drifts as it grows
// (map_drift.hpp), so that on revisited ground scan poses do not drift. States are at least `node_s` apart,
// because errors of successive scans are strongly correlated; poses in between follow the IMU, or the scans
// where IMU samples are missing.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/inertial.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/inertial_params.hpp"

namespace radioslam {

/// Result of smoothing; z is up.
struct InertialOdometry {
  std::vector<SE3> poses;                ///< of the scans
  std::vector<OdometryStepNoise> steps;  ///< between successive states
  double cost_per_step = 0;              ///< squared norm of the residuals per step
};

/// Nothing if gravity cannot be estimated or the smoother refuses.
std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<ImuSample>& samples,
                                             const InertialParams& params);

}  // namespace radioslam

// LiDAR-inertial odometry: smooths a robot's registered scans together with its IMU samples.
//
// The smoother (inertial/inertial_smoother.hpp) estimates all states at once. A scan contributes the
// information of its points, which is none along a featureless corridor; the map drifts as it grows
// (map_drift.hpp), so that on revisited ground scan poses do not drift. States are at least `node_s` apart,
// because errors of successive scans are strongly correlated; poses in between follow the IMU, or the scans
// where IMU samples are missing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/inertial_params.hpp"
#include "radioslam/odometry/scan_tracking.hpp"

namespace radioslam {

/// Replaces the poses of scans, and the covariances of their steps, by those from scans and IMU. Where it
/// cannot it returns why, in words that follow a robot's name, and changes nothing.
std::optional<std::string> smooth_with_imu(ScanTrajectory& track, const std::vector<ImuSample>& samples,
                                           const InertialParams& params);

}  // namespace radioslam

// Recordings of a robot team, in time order. Parsing is in io/, ground truth in truth.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/csi.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/lidar.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

// IMU samples of a robot.

/// IMU sample in the robot's body frame; the sensor is at the body's origin.
struct ImuSample {
  Stamp stamp;
  /// Acceleration minus gravity: (0, 0, +9.81) at rest and level.
  Eigen::Vector3d specific_force_mps2;
  Eigen::Vector3d angular_rate_radps;
};

/// Noise recorded with the odometry, between two consecutive samples.
struct OdometryStepNoise {
  Stamp begin, end;
  /// Covariance of the motion per second, for T * Exp(xi), xi = [translation; rotation]; m^2/s, rad^2/s.
  SE3::Jacobian covariance_per_s = SE3::Jacobian::Zero();
};

/// Noise of a robot's odometry as a random walk along the path: after d metres and theta radians of rotation,
/// the variance is sigma_xy_per_sqrt_m^2 d in x and y each, and sigma_yaw_per_sqrt_m_rad^2 d +
/// sigma_yaw_per_rad^2 |theta| in yaw (not (sigma_yaw_per_rad theta)^2, which would depend on how a turn is
/// split; docs/decisions/graph.md). Yaw drift and scale error are constant over the mission and unknown.
struct OdometryNoise {
  double sigma_xy_per_sqrt_m = 0.02;
  double sigma_yaw_per_sqrt_m_rad = 0.002;
  double sigma_yaw_per_rad = 0.01;
  double sigma_z_per_sqrt_m = 0.01;
  double sigma_yaw_drift_per_m_rad = 0;  ///< prior of a constant yaw drift
  double sigma_scale = 0;                ///< prior of a constant relative error of the path length
  std::vector<OdometryStepNoise> steps;  ///< measured; replace the random walk where present
};

/// Reference of the odometry's yaw.
enum class Heading {
  kRelative,  ///< the robot's own start
  kAbsolute,  ///< a compass or AHRS: the same direction for every robot, up to sigma_heading_rad
};

/// Index into Mission::access_points.
using AccessPointIndex = StrongId<struct AccessPointTag>;

/// Signal strength of one access point in a scan.
struct WifiReading {
  AccessPointIndex access_point;
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// All access points detected at one stamp, ordered by access point.
struct WifiScan {
  Stamp stamp;
  std::vector<WifiReading> readings;
};

/// One robot's recordings.
struct Robot {
  std::string id;
  /// T_start_body, at least one pose; may be empty with LiDAR scans, from which it is then estimated.
  Trajectory<SE3> odometry;
  OdometryNoise odometry_noise;
  std::vector<Stamp> keyframes;  ///< as the robot chose them on its way; empty: choose_keyframes
  Heading heading = Heading::kRelative;
  double sigma_heading_rad = 0.2;   ///< constant error of an absolute heading
  std::optional<SE3> initial_pose;  ///< T_common_start, gravity-aligned; absent when unknown
  double lidar_range_m = 30;
  double lidar_view_rad = 2 * std::numbers::pi;  ///< width of the horizontal field of view, about body x
  std::vector<WifiScan> wifi;                    ///< in time order
  std::vector<PositionFix> fixes;                ///< in time order
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();  ///< antenna position in the body frame
  std::optional<CsiRecording> csi;  ///< channel state information recorded by its WiFi card
  LidarLog lidar;                   ///< may be empty
  std::vector<ImuSample> inertial;  ///< strictly increasing in time; may be empty
};

/// A team's recordings.
struct Mission {
  std::string name;
  int dimension = 2;  ///< 2: planar estimate; 3: spatial estimate
  std::vector<Robot> robots;
  std::vector<std::string> access_points;  ///< BSSIDs, lower case, sorted
  std::vector<Anchor> anchors;
  std::vector<RangeMeasurement> ranges;          ///< in time order, then as recorded
  std::vector<AoaMeasurement> aoa_measurements;  ///< in time order, then as recorded
  std::vector<PoseMatch> matches;                ///< as recorded
  std::vector<std::string> unused_files;         ///< recorded and well-formed, but not used by any estimator
  std::vector<Finding> reading_findings;         ///< what only the readers saw: values that reading changes
};

/// Per robot its initial pose in the common frame; nothing where it is unknown.
using KnownStarts = std::vector<std::optional<SE3>>;

/// The starts that the mission states.
inline KnownStarts known_starts(const Mission& mission) {
  KnownStarts starts;
  for (const Robot& robot : mission.robots) starts.push_back(robot.initial_pose);
  return starts;
}

inline bool has_known_starts(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return robot.initial_pose.has_value(); });
}

}  // namespace radioslam

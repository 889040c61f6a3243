// What the robots recorded, in time order. No parsing here (see io/), and no truth (see truth.hpp).
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/csi.hpp"
#include "radioslam/mission/inertial.hpp"
#include "radioslam/mission/lidar.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Noise measured along with the odometry, between one row and the next.
struct OdometryStepNoise {
  Stamp begin, end;
  /// Of the motion's error per second, of T * Exp(xi), xi = [translation; rotation]; m^2/s, rad^2/s.
  SE3::Jacobian covariance_per_s = SE3::Jacobian::Zero();
};

/// Noise of a robot's odometry as a random walk over the way: after d metres and theta radians of turning,
/// variance sigma_xy_per_sqrt_m^2 d in x and in y each, and sigma_yaw_per_sqrt_m_rad^2 d +
/// sigma_yaw_per_rad^2 |theta| in yaw (not (sigma_yaw_per_rad theta)^2, which depends on how a turn is cut;
/// docs/decisions.md). The last two are constant over the mission and unknown.
struct OdometryNoise {
  double sigma_xy_per_sqrt_m = 0.02;
  double sigma_yaw_per_sqrt_m_rad = 0.002;
  double sigma_yaw_per_rad = 0.01;
  double sigma_z_per_sqrt_m = 0.01;
  double sigma_yaw_drift_per_m_rad = 0;  ///< prior of a constant yaw drift
  double sigma_scale = 0;                ///< prior of a constant relative error of the distance walked
  std::vector<OdometryStepNoise> steps;  ///< measured; where there are any, they stand for the random walk
};

/// What the yaw of the odometry refers to.
enum class Heading {
  kRelative,  ///< the robot's own start
  kAbsolute,  ///< a compass or AHRS: the same direction for every robot, up to sigma_heading_rad
};

/// An access point's place in Mission::access_points.
using AccessPointIndex = StrongId<struct AccessPointTag>;

/// One access point heard in a scan.
struct WifiReading {
  AccessPointIndex access_point;
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// All access points heard at one stamp, ordered by access point.
struct WifiScan {
  Stamp stamp;
  std::vector<WifiReading> readings;
};

/// One robot's recordings.
struct Robot {
  std::string id;
  /// T_start_body, at least one pose; none where there are scans, from which it is then estimated.
  Trajectory<SE3> odometry;
  OdometryNoise odometry_noise;
  Heading heading = Heading::kRelative;
  double sigma_heading_rad = 0.2;   ///< of an absolute heading's constant error
  std::optional<SE3> initial_pose;  ///< T_common_start, gravity-aligned; absent when unknown
  double lidar_range_m = 30;
  double lidar_view_rad = 2 * std::numbers::pi;  ///< width of the horizontal field of view, about body x
  std::vector<WifiScan> wifi;                    ///< in time order
  std::vector<PositionFix> fixes;                ///< in time order
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();  ///< their antenna in the body frame
  std::optional<CsiRecording> csi;       ///< what its WiFi card measured of the packets it heard
  LidarLog lidar;                        ///< may be empty
  std::vector<InertialSample> inertial;  ///< strictly increasing in time; may be empty
};

/// A team's recordings.
struct Mission {
  std::string name;
  int dimension = 2;  ///< 2: the estimate moves in the plane; 3: in space
  std::vector<Robot> robots;
  std::vector<std::string> access_points;  ///< BSSIDs, lower case, sorted
  std::vector<Anchor> anchors;
  std::vector<RangeMeasurement> ranges;      ///< in the order of time, then as recorded
  std::vector<ArrivalMeasurement> arrivals;  ///< likewise
  std::vector<PoseMatch> matches;            ///< as recorded
  std::vector<std::string> unused_files;     ///< recorded and well-formed, but read by no estimator yet
};

}  // namespace radioslam

// The message types of ROS that a robot's recordings are made of, in ROS 1 and ROS 2 alike.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/point_times.hpp"
#include "radioslam/io/ros_message.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// A pose or a transform: T_frame_child.
struct RosPose {
  RosHeader header;
  std::string child;  ///< empty where the type names none
  /// Nothing where its numbers are no pose: not finite, or no rotation.
  std::optional<SE3> pose;
};

struct RosScan {
  RosHeader header;
  LidarScan scan;          ///< in the sensor's frame
  double range_max_m = 0;  ///< of a LaserScan; 0 where not told
  PointClock clock = PointClock::kScans;
};

struct RosInertial {
  RosHeader header;
  Eigen::Vector3d specific_force_mps2;
  Eigen::Vector3d angular_rate_radps;
  bool is_whole = true;  ///< the unit measures both: neither covariance begins with -1
};

/// sensor_msgs/NavSatFix.
struct RosFix {
  RosHeader header;
  std::optional<GeodeticPlace> place;  ///< nothing without a fix; a height that is not told is NaN
  std::optional<double> sigma_m;       ///< of the worst axis; nothing where not told
};

/// nav_msgs/Odometry, geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped.
bool is_pose_type(std::string_view type);
/// tf2_msgs/TFMessage, tf/tfMessage.
bool is_transforms_type(std::string_view type);
/// sensor_msgs/PointCloud2, sensor_msgs/LaserScan, livox_ros_driver2/CustomMsg and its forerunners.
bool is_scan_type(std::string_view type);
inline constexpr std::string_view kOdometryType = "nav_msgs/Odometry";
inline constexpr std::string_view kInertialType = "sensor_msgs/Imu";
inline constexpr std::string_view kFixType = "sensor_msgs/NavSatFix";
inline constexpr std::string_view kLaserScanType = "sensor_msgs/LaserScan";
inline constexpr std::string_view kPointCloudType = "sensor_msgs/PointCloud2";

/// The message must be of a pose type, and so on.
RosPose read_ros_pose(const RosMessage& message);
std::vector<RosPose> read_ros_transforms(const RosMessage& message);
/// Of a PointCloud2 or Livox's CustomMsg all points; of a LaserScan, in the plane z = 0, the readings within
/// its limits (a largest range of 0 is none). Times are since time_of the message: those of a PointCloud2 in
/// `unit` (point_times.hpp), those of a LaserScan where it has a time increment.
RosScan read_ros_scan(const RosMessage& message, std::optional<PointTimeUnit> unit = std::nullopt);
/// Of a PointCloud2, for the search of its unit; of other scans nothing.
std::optional<RawPointTimes> read_ros_point_times(const RosMessage& message);
RosInertial read_ros_inertial(const RosMessage& message);
RosFix read_ros_fix(const RosMessage& message);

}  // namespace radioslam

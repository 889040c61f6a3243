// Parses the ROS message types that can be imported, for ROS 1 and ROS 2 alike.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/local_frame.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/lidar/point_times.hpp"
#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/text/byte_cursor.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

// Sequential reader of the values in a serialised ROS message: ROS 1 (little endian, unaligned) or the Common
// Data Representation (CDR) of ROS 2 (either byte order, numbers aligned to their size after a header of four
// bytes).

/// std_msgs/Header.
struct RosHeader {
  Stamp stamp;
  std::string frame;  ///< without a leading slash
};

/// The header's stamp, or the recording time if it has none.
Stamp time_of(const RosMessage& message, const RosHeader& header);

/// Every read throws InputError (with topic and byte) if the message ends before the value.
class RosMessageReader {
 public:
  /// Refuses an encapsulation other than plain CDR.
  explicit RosMessageReader(const RosMessage& message);

  bool boolean() { return cursor_.u8() != 0; }
  std::uint8_t u8() { return cursor_.u8(); }
  std::uint16_t u16() { return align(2), cursor_.u16(); }
  std::int32_t i32() { return align(4), cursor_.i32(); }
  std::uint32_t u32() { return align(4), cursor_.u32(); }
  float f32() { return align(4), cursor_.f32(); }
  std::uint64_t u64() { return align(8), cursor_.u64(); }
  double f64() { return align(8), cursor_.f64(); }
  std::string text();
  std::string frame();
  RosHeader header();
  /// The number of elements that follow; refused if the message is too short for them at `min_bytes` each.
  std::size_t count(std::size_t min_bytes);
  /// The next bytes, unchanged.
  std::string_view take(std::size_t bytes) { return cursor_.take(bytes); }

  ByteOrder order() const { return order_; }
  std::size_t left() const { return cursor_.left(); }
  [[noreturn]] void fail(const std::string& reason) const { cursor_.fail(reason); }

 private:
  void align(std::size_t bytes);

  bool is_cdr_;
  ByteOrder order_;
  std::string part_;
  ByteCursor cursor_;
};

/// A pose or a transform: T_frame_child.
struct RosPose {
  RosHeader header;
  std::string child;  ///< empty if the type has none
  /// Nothing if the numbers are not finite or not a rotation.
  std::optional<SE3> pose;
};

struct RosScan {
  RosHeader header;
  LidarScan scan;          ///< in the sensor's frame
  double range_max_m = 0;  ///< of a LaserScan; 0 if not stated
  PointClock clock = PointClock::kScans;
};

struct RosImu {
  RosHeader header;
  Eigen::Vector3d specific_force_mps2;
  Eigen::Vector3d angular_rate_radps;
  bool is_complete = true;  ///< both quantities are measured: neither covariance begins with -1
};

/// sensor_msgs/NavSatFix.
struct RosFix {
  RosHeader header;
  /// Nothing without a fix, as are latitude and longitude 0 without a covariance, which receivers send before
  /// they have one; an unknown altitude is NaN.
  std::optional<GeodeticPlace> place;
  std::optional<double> sigma_m;  ///< of the worst axis; nothing if not stated
};

/// sensor_msgs/Range.
struct RosRangeReading {
  RosHeader header;
  double range_m = 0;
  bool is_valid = true;           ///< finite, positive and within the limits, if the message states them
  std::optional<double> sigma_m;  ///< nothing if not stated
};

/// nav_msgs/Odometry, geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped.
bool is_pose_type(std::string_view type);
/// tf2_msgs/TFMessage, tf/tfMessage.
bool is_transforms_type(std::string_view type);
/// sensor_msgs/PointCloud2, sensor_msgs/LaserScan, livox_ros_driver2/CustomMsg and its forerunners.
bool is_scan_type(std::string_view type);
inline constexpr std::string_view kOdometryType = "nav_msgs/Odometry";
inline constexpr std::string_view kImuType = "sensor_msgs/Imu";
inline constexpr std::string_view kFixType = "sensor_msgs/NavSatFix";
inline constexpr std::string_view kRangeType = "sensor_msgs/Range";
inline constexpr std::string_view kLaserScanType = "sensor_msgs/LaserScan";
inline constexpr std::string_view kPointCloudType = "sensor_msgs/PointCloud2";

/// Each function requires a message of the corresponding type.
RosPose read_ros_pose(const RosMessage& message);
std::vector<RosPose> read_ros_transforms(const RosMessage& message);
/// All points of a PointCloud2 or Livox CustomMsg; for a LaserScan, the readings within its range limits in
/// the plane z = 0 (a maximum range of 0 means no limit). Times are relative to time_of the message; those of
/// a PointCloud2 are in `unit` (point_times.hpp), a LaserScan has times if its time increment is set.
RosScan read_ros_scan(const RosMessage& message, std::optional<PointTimeUnit> unit = std::nullopt);
/// The raw times of a PointCloud2, for determining their unit; nothing for other scans.
std::optional<RawPointTimes> read_ros_point_times(const RosMessage& message);
RosImu read_ros_imu(const RosMessage& message);
RosFix read_ros_fix(const RosMessage& message);
RosRangeReading read_ros_range(const RosMessage& message);

}  // namespace radioslam

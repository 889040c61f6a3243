#include "radioslam/io/ros_types.hpp"

#include <array>
#include <cmath>

#include "radioslam/io/fields_of_line.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/point_table.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLeastTransformBytes = 68;
constexpr std::size_t kLeastPointFieldBytes = 13;
constexpr int kCovarianceNumbers = 9;

Eigen::Vector3d read_ros_vector(RosMessageReader& reader) {
  const double x = reader.f64();
  const double y = reader.f64();
  return {x, y, reader.f64()};
}

/// Position, then x y z w of the orientation, as geometry_msgs/Pose and Transform have them.
std::optional<SE3> read_position_and_orientation(RosMessageReader& reader) {
  const Eigen::Vector3d position = read_ros_vector(reader);
  Eigen::Vector4d xyzw;
  for (double& number : xyzw) number = reader.f64();
  const double norm = xyzw.norm();
  if (!position.allFinite() || !(std::abs(norm - 1) < kUnitQuaternionTolerance)) return std::nullopt;
  if (position.cwiseAbs().maxCoeff() > kLargestCoordinate_m) return std::nullopt;
  return SE3(position, Eigen::Quaterniond(Eigen::Vector4d(xyzw / norm)));
}

RosPose read_transform(RosMessageReader& reader) {
  RosPose transform;
  transform.header = reader.header();
  transform.child = reader.frame();
  transform.pose = read_position_and_orientation(reader);
  return transform;
}

std::optional<NumberType> type_of_datatype(std::uint8_t datatype) {
  constexpr std::array<NumberType, 8> kTypes{NumberType::kInt8,    NumberType::kUint8,  NumberType::kInt16,
                                             NumberType::kUint16,  NumberType::kInt32,  NumberType::kUint32,
                                             NumberType::kFloat32, NumberType::kFloat64};
  if (datatype < 1 || datatype > kTypes.size()) return std::nullopt;
  return kTypes[datatype - 1U];
}

std::vector<PointColumn> read_point_fields(RosMessageReader& reader) {
  std::vector<PointColumn> columns;
  const std::size_t fields = reader.count(kLeastPointFieldBytes);
  for (std::size_t k = 0; k < fields; ++k) {
    PointColumn column;
    column.name = reader.text();
    column.offset = reader.u32();
    const auto type = type_of_datatype(reader.u8());
    reader.u32();  // how many of them
    if (!type) continue;
    column.type = *type;
    columns.push_back(column);
  }
  return columns;
}

/// The rows of an image of points without what lies between them.
std::string without_padding(std::string_view data, std::size_t height, std::size_t row_bytes,
                            std::size_t row_step) {
  std::string rows;
  for (std::size_t row = 0; row < height; ++row) rows += data.substr(row * row_step, row_bytes);
  return rows;
}

RosScan read_point_cloud(RosMessageReader& reader) {
  RosScan scan{reader.header(), {}};
  const std::size_t height = reader.u32();
  const std::size_t width = reader.u32();
  PointTable table{{}, ByteOrder::kLittle, 0, read_point_fields(reader)};
  if (reader.boolean()) table.order = ByteOrder::kBig;
  const std::size_t point_step = reader.u32();
  const std::size_t row_step = reader.u32();
  table.bytes = reader.take(reader.count(1));
  if (width == 0 || height == 0) return scan;
  const std::size_t row_bytes = width * point_step;  // of 32 bits each: it fits
  const bool is_padded = height > 1 && row_step > row_bytes;
  if (point_step == 0 || (is_padded ? row_step : row_bytes) > table.bytes.size() / height)
    reader.fail("the cloud has fewer points than its height and width say");
  std::string rows;
  if (is_padded) table.bytes = rows = without_padding(table.bytes, height, row_bytes, row_step);
  table.rows = width * height;
  for (PointColumn& column : table.columns) column.stride = point_step;
  if (const auto refusal = refusal_of(table)) reader.fail(*refusal);
  scan.scan = points_of(table, scan.header.stamp);
  return scan;
}

struct LaserScanFan {
  double begin_rad = 0, step_rad = 0, time_step_s = 0, least_m = 0, most_m = 0;
};

LaserScanFan read_fan(RosMessageReader& reader) {
  LaserScanFan fan;
  fan.begin_rad = static_cast<double>(reader.f32());
  reader.f32();  // where it ends
  fan.step_rad = static_cast<double>(reader.f32());
  fan.time_step_s = static_cast<double>(reader.f32());
  reader.f32();  // time between scans
  fan.least_m = static_cast<double>(reader.f32());
  fan.most_m = static_cast<double>(reader.f32());
  return fan;
}

RosScan read_laser_scan(RosMessageReader& reader) {
  RosScan scan{reader.header(), {}};
  const LaserScanFan fan = read_fan(reader);
  if (std::isfinite(fan.most_m) && fan.most_m > 0) scan.range_max_m = fan.most_m;
  const std::size_t readings = reader.count(sizeof(float));
  for (std::size_t k = 0; k < readings; ++k) {
    const auto range_m = static_cast<double>(reader.f32());
    if (!std::isfinite(range_m) || !(range_m >= fan.least_m && range_m <= fan.most_m)) continue;
    const double angle_rad = fan.begin_rad + static_cast<double>(k) * fan.step_rad;
    scan.scan.points.emplace_back(static_cast<float>(range_m * std::cos(angle_rad)),
                                  static_cast<float>(range_m * std::sin(angle_rad)), 0.0F);
    if (fan.time_step_s > 0)
      scan.scan.times_s.push_back(static_cast<float>(static_cast<double>(k) * fan.time_step_s));
  }
  return scan;
}

}  // namespace

bool is_pose_type(std::string_view type) {
  return type == kOdometryType || type == "geometry_msgs/PoseStamped" ||
         type == "geometry_msgs/PoseWithCovarianceStamped" || type == "geometry_msgs/TransformStamped";
}

bool is_transforms_type(std::string_view type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

bool is_scan_type(std::string_view type) {
  return type == "sensor_msgs/PointCloud2" || type == kLaserScanType;
}

RosPose read_ros_pose(const RosMessage& message) {
  RosMessageReader reader(message);
  if (message.channel.type == "geometry_msgs/TransformStamped") return read_transform(reader);
  RosPose pose;
  pose.header = reader.header();
  if (message.channel.type == kOdometryType) pose.child = reader.frame();
  pose.pose = read_position_and_orientation(reader);
  return pose;
}

std::vector<RosPose> read_ros_transforms(const RosMessage& message) {
  RosMessageReader reader(message);
  std::vector<RosPose> transforms;
  const std::size_t count = reader.count(kLeastTransformBytes);
  for (std::size_t k = 0; k < count; ++k) transforms.push_back(read_transform(reader));
  return transforms;
}

RosScan read_ros_scan(const RosMessage& message) {
  RosMessageReader reader(message);
  return message.channel.type == kLaserScanType ? read_laser_scan(reader) : read_point_cloud(reader);
}

RosInertial read_ros_inertial(const RosMessage& message) {
  RosMessageReader reader(message);
  RosInertial inertial;
  inertial.header = reader.header();
  constexpr int kOrientationNumbers = 4;
  for (int k = 0; k < kOrientationNumbers + kCovarianceNumbers; ++k) reader.f64();
  inertial.angular_rate_radps = read_ros_vector(reader);
  for (int k = 0; k < kCovarianceNumbers; ++k) reader.f64();
  inertial.specific_force_mps2 = read_ros_vector(reader);
  return inertial;
}

}  // namespace radioslam

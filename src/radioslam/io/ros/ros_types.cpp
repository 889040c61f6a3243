#include "radioslam/io/ros/ros_types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;

bool is_cdr(const RosMessage& message) { return message.channel.encoding == MessageEncoding::kCdr; }

/// CDR header: 0 0 means big endian, 0 1 little endian; anything else is not plain CDR.
ByteOrder order_of(const RosMessage& message) {
  const bool is_big = is_cdr(message) && message.bytes.starts_with(std::string_view("\0\0", 2));
  return is_big ? ByteOrder::kBig : ByteOrder::kLittle;
}

constexpr std::size_t kMinTransformBytes = 68;
constexpr std::size_t kMinPointFieldBytes = 13;
constexpr int kCovarianceNumbers = 9;
constexpr double kMaxHeight_m = 1e6;
constexpr std::size_t kLivoxPointBytes = 19;
constexpr int kLivoxIdBytes = 4;  ///< the scanner's id and three reserved bytes
constexpr int kLivoxMarks = 3;    ///< reflectivity, tag and line, one byte each

Eigen::Vector3d read_ros_vector(RosMessageReader& reader) {
  const double x = reader.f64();
  const double y = reader.f64();
  return {x, y, reader.f64()};
}

/// Whether the quantity was measured (its covariance does not begin with -1).
bool skip_covariance(RosMessageReader& reader) {
  const double first = reader.f64();
  for (int k = 1; k < kCovarianceNumbers; ++k) reader.f64();
  return first != -1;
}

/// Position, then orientation x y z w, as in geometry_msgs/Pose and Transform.
std::optional<SE3> read_position_and_orientation(RosMessageReader& reader) {
  const Eigen::Vector3d position = read_ros_vector(reader);
  Eigen::Vector4d xyzw;
  for (double& number : xyzw) number = reader.f64();
  const double norm = xyzw.norm();
  if (!position.allFinite() || !(std::abs(norm - 1) < kUnitQuaternionTolerance)) return std::nullopt;
  if (position.cwiseAbs().maxCoeff() > kMaxCoordinate_m) return std::nullopt;
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
  const std::size_t fields = reader.count(kMinPointFieldBytes);
  for (std::size_t k = 0; k < fields; ++k) {
    PointColumn column;
    column.name = reader.text();
    column.offset = reader.u32();
    const auto type = type_of_datatype(reader.u8());
    reader.u32();  // number of transforms
    if (!type) continue;
    column.type = *type;
    columns.push_back(column);
  }
  return columns;
}

/// The rows of an organised cloud without the padding between them.
std::string without_padding(std::string_view data, std::size_t height, std::size_t row_bytes,
                            std::size_t row_step) {
  std::string rows;
  for (std::size_t row = 0; row < height; ++row) rows += data.substr(row * row_step, row_bytes);
  return rows;
}

/// The points of a PointCloud2; its references remain valid when it is moved.
struct RosPointCloud {
  RosHeader header;
  std::unique_ptr<std::string> without_gaps;  ///< a copy without padding, if the rows are padded
  PointTable table;
};

/// Dimensions of an organised cloud.
struct CloudRows {
  std::size_t height, width, point_step, row_step;
};

void fill_table(RosMessageReader& reader, const CloudRows& rows, RosPointCloud& cloud) {
  PointTable& table = cloud.table;
  const std::size_t row_bytes = rows.width * rows.point_step;  // both have 32 bits, so the product fits
  const bool is_padded = rows.height > 1 && rows.row_step > row_bytes;
  if (rows.point_step == 0 || (is_padded ? rows.row_step : row_bytes) > table.bytes.size() / rows.height)
    reader.fail("the cloud has fewer points than its height and width state");
  if (is_padded) {
    cloud.without_gaps =
        std::make_unique<std::string>(without_padding(table.bytes, rows.height, row_bytes, rows.row_step));
    table.bytes = *cloud.without_gaps;
  }
  table.rows = rows.width * rows.height;
  for (PointColumn& column : table.columns) column.stride = rows.point_step;
  if (const auto refusal = problem_with(table)) reader.fail(*refusal);
}

/// A cloud of height or width zero has no rows.
RosPointCloud read_point_cloud(RosMessageReader& reader) {
  RosPointCloud cloud{reader.header(), nullptr, {}};
  CloudRows rows{};
  rows.height = reader.u32();
  rows.width = reader.u32();
  cloud.table.columns = read_point_fields(reader);
  if (reader.boolean()) cloud.table.order = ByteOrder::kBig;
  rows.point_step = reader.u32();
  rows.row_step = reader.u32();
  cloud.table.bytes = reader.take(reader.count(1));
  if (rows.width > 0 && rows.height > 0) fill_table(reader, rows, cloud);
  return cloud;
}

RosScan read_cloud_scan(const RosMessage& message, std::optional<PointTimeUnit> unit) {
  RosMessageReader reader(message);
  const RosPointCloud cloud = read_point_cloud(reader);
  RosScan scan{cloud.header, {}};
  if (cloud.table.rows == 0) return scan;
  scan.scan.points = points_of(cloud.table);
  scan.scan.intensities = intensities_of(cloud.table);
  PointTimes times = times_of(cloud.table, time_of(message, cloud.header), unit);
  scan.scan.times_s = std::move(times.since_stamp_s);
  scan.clock = times.clock;
  return scan;
}

/// Livox CustomMsg: times are relative to the time base, which equals the header's stamp.
RosScan read_livox_scan(RosMessageReader& reader) {
  RosScan scan{reader.header(), {}};
  reader.u64();  // time base
  reader.u32();  // number of points
  for (int k = 0; k < kLivoxIdBytes; ++k) reader.u8();
  const std::size_t points = reader.count(kLivoxPointBytes);
  for (std::size_t k = 0; k < points; ++k) {
    scan.scan.times_s.push_back(static_cast<float>(reader.u32() * kSecondsPerNanosecond));
    Eigen::Vector3f& point = scan.scan.points.emplace_back();
    for (float& coordinate : point) coordinate = reader.f32();
    scan.scan.intensities.push_back(static_cast<float>(reader.u8()));
    for (int byte = 1; byte < kLivoxMarks; ++byte) reader.u8();
  }
  const auto [first, last] = std::minmax_element(scan.scan.times_s.begin(), scan.scan.times_s.end());
  if (points > 1 && *first == *last) {
    scan.scan.times_s.clear();
    scan.clock = PointClock::kConstant;
  }
  return scan;
}

struct LaserScanFan {
  double begin_rad = 0, step_rad = 0, time_step_s = 0, min_m = 0, max_m = 0;
};

LaserScanFan read_fan(RosMessageReader& reader) {
  LaserScanFan fan;
  fan.begin_rad = static_cast<double>(reader.f32());
  reader.f32();  // angle_max
  fan.step_rad = static_cast<double>(reader.f32());
  fan.time_step_s = static_cast<double>(reader.f32());
  reader.f32();  // time between scans
  fan.min_m = static_cast<double>(reader.f32());
  fan.max_m = static_cast<double>(reader.f32());
  if (!(fan.max_m > 0)) fan.max_m = std::numeric_limits<double>::infinity();  // not set
  return fan;
}

RosScan read_laser_scan(RosMessageReader& reader) {
  RosScan scan{reader.header(), {}};
  const LaserScanFan fan = read_fan(reader);
  if (std::isfinite(fan.max_m)) scan.range_max_m = fan.max_m;
  const std::size_t readings = reader.count(sizeof(float));
  std::vector<std::size_t> returned;
  for (std::size_t k = 0; k < readings; ++k) {
    const auto range_m = static_cast<double>(reader.f32());
    if (!std::isfinite(range_m) || !(range_m >= fan.min_m && range_m <= fan.max_m)) continue;
    returned.push_back(k);
    const double angle_rad = fan.begin_rad + static_cast<double>(k) * fan.step_rad;
    scan.scan.points.emplace_back(static_cast<float>(range_m * std::cos(angle_rad)),
                                  static_cast<float>(range_m * std::sin(angle_rad)), 0.0F);
    if (fan.time_step_s > 0)
      scan.scan.times_s.push_back(static_cast<float>(static_cast<double>(k) * fan.time_step_s));
  }
  std::vector<float> intensities(reader.count(sizeof(float)));
  for (float& intensity : intensities) intensity = reader.f32();
  if (intensities.size() != readings) return scan;  // most drivers leave them out
  for (const std::size_t k : returned) scan.scan.intensities.push_back(intensities[k]);
  return scan;
}

}  // namespace

Stamp time_of(const RosMessage& message, const RosHeader& header) {
  return header.stamp != Stamp{} ? header.stamp : message.stamp;
}

RosMessageReader::RosMessageReader(const RosMessage& message)
    : is_cdr_(is_cdr(message)),
      order_(order_of(message)),
      part_("a message of " + message.channel.topic),
      cursor_(message.bytes, order_, {message.file, part_}) {
  if (!is_cdr_) return;
  const std::string_view encapsulation = cursor_.take(kEncapsulationBytes);
  if (encapsulation[0] != 0 || static_cast<unsigned char>(encapsulation[1]) > 1)
    cursor_.fail("not encoded as plain CDR");
}

void RosMessageReader::align(std::size_t bytes) {
  if (!is_cdr_) return;
  const std::size_t over = (cursor_.position() - kEncapsulationBytes) % bytes;
  if (over > 0) cursor_.take(bytes - over);
}

std::string RosMessageReader::text() {
  std::string_view bytes = cursor_.take(u32());
  if (is_cdr_ && !bytes.empty()) bytes.remove_suffix(1);  // terminating zero
  return std::string(bytes);
}

std::string RosMessageReader::frame() {
  std::string name = text();
  return name.starts_with('/') ? name.substr(1) : name;
}

RosHeader RosMessageReader::header() {
  if (!is_cdr_) u32();  // seq
  const std::int64_t seconds = is_cdr_ ? std::int64_t{i32()} : std::int64_t{u32()};
  const Stamp stamp{seconds * kNanosecondsPerSecond + u32()};
  return {stamp, frame()};
}

std::size_t RosMessageReader::count(std::size_t min_bytes) {
  const std::size_t elements = u32();
  if (elements > cursor_.left() / min_bytes)
    cursor_.fail("the message ends within its " + std::to_string(elements) + " elements");
  return elements;
}

bool is_pose_type(std::string_view type) {
  return type == kOdometryType || type == "geometry_msgs/PoseStamped" ||
         type == "geometry_msgs/PoseWithCovarianceStamped" || type == "geometry_msgs/TransformStamped";
}

bool is_transforms_type(std::string_view type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

bool is_scan_type(std::string_view type) {
  return type == kPointCloudType || type == kLaserScanType ||
         (type.starts_with("livox") && type.ends_with("/CustomMsg"));
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
  const std::size_t count = reader.count(kMinTransformBytes);
  for (std::size_t k = 0; k < count; ++k) transforms.push_back(read_transform(reader));
  return transforms;
}

RosScan read_ros_scan(const RosMessage& message, std::optional<PointTimeUnit> unit) {
  if (message.channel.type == kPointCloudType) return read_cloud_scan(message, unit);
  RosMessageReader reader(message);
  return message.channel.type == kLaserScanType ? read_laser_scan(reader) : read_livox_scan(reader);
}

std::optional<RawPointTimes> read_ros_point_times(const RosMessage& message) {
  if (message.channel.type != kPointCloudType) return std::nullopt;
  RosMessageReader reader(message);
  const RosPointCloud cloud = read_point_cloud(reader);
  return cloud.table.rows == 0 ? std::nullopt : raw_times_of(cloud.table);
}

RosImu read_ros_imu(const RosMessage& message) {
  RosMessageReader reader(message);
  RosImu inertial;
  inertial.header = reader.header();
  constexpr int kOrientationNumbers = 4;
  for (int k = 0; k < kOrientationNumbers; ++k) reader.f64();
  skip_covariance(reader);
  inertial.angular_rate_radps = read_ros_vector(reader);
  const bool has_rate = skip_covariance(reader);
  inertial.specific_force_mps2 = read_ros_vector(reader);
  inertial.is_complete = skip_covariance(reader) && has_rate;
  return inertial;
}

RosFix read_ros_fix(const RosMessage& message) {
  RosMessageReader reader(message);
  RosFix fix{reader.header(), std::nullopt, std::nullopt};
  const bool has_fix = static_cast<std::int8_t>(reader.u8()) >= 0;
  reader.u16();  // satellite service
  const double latitude_deg = reader.f64();
  const double longitude_deg = reader.f64();
  const double height_m = reader.f64();
  Eigen::Matrix3d covariance;
  for (double& number : covariance.reshaped()) number = reader.f64();
  const bool has_covariance = reader.u8() != 0;
  const bool is_on_earth =
      std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 360 && !(std::abs(height_m) > kMaxHeight_m);
  const int axes = std::isfinite(height_m) ? 3 : 2;
  const auto variances = covariance.diagonal().head(axes);
  if (has_covariance && variances.allFinite() && variances.maxCoeff() > 0)
    fix.sigma_m = std::sqrt(variances.maxCoeff());
  const bool is_unset = latitude_deg == 0 && longitude_deg == 0 && !fix.sigma_m;
  if (has_fix && is_on_earth && !is_unset)
    fix.place = GeodeticPlace{latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
  return fix;
}

RosRangeReading read_ros_range(const RosMessage& message) {
  RosMessageReader reader(message);
  RosRangeReading reading;
  reading.header = reader.header();
  reader.u8();   // kind of radiation
  reader.f32();  // field of view
  const auto min_m = static_cast<double>(reader.f32());
  const auto max_m = static_cast<double>(reader.f32());
  reading.range_m = static_cast<double>(reader.f32());
  const bool has_limits = max_m > min_m;
  reading.is_valid = std::isfinite(reading.range_m) && reading.range_m > 0 &&
                     (!has_limits || (reading.range_m >= min_m && reading.range_m <= max_m));
  if (reader.left() < sizeof(float)) return reading;  // no variance before ROS 2 Jazzy
  const auto variance = static_cast<double>(reader.f32());
  if (variance > 0 && std::isfinite(variance)) reading.sigma_m = std::sqrt(variance);
  return reading;
}

}  // namespace radioslam

#include "radioslam/io/ros/ros_output.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr int kPoseCovarianceNumbers = 36, kTwistNumbers = 6;
constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint32_t kPointBytes = 16;
constexpr std::int32_t kLineList = 5;

void write_time(CdrWriter& out, Stamp stamp) {
  const std::int64_t seconds =
      stamp.ns / kNanosecondsPerSecond - (stamp.ns % kNanosecondsPerSecond < 0 ? 1 : 0);
  out.i32(static_cast<std::int32_t>(seconds));
  out.u32(static_cast<std::uint32_t>(stamp.ns - seconds * kNanosecondsPerSecond));
}

void write_vector(CdrWriter& out, const Eigen::Vector3d& vector) {
  for (const double number : vector) out.f64(number);
}

/// Position, then orientation x y z w.
void write_pose(CdrWriter& out, const SE3& pose) {
  write_vector(out, pose.translation());
  for (const double number : pose.rotation().coeffs()) out.f64(number);
}

void write_zeros(CdrWriter& out, int count) {
  for (int k = 0; k < count; ++k) out.f64(0);
}

void write_colour(CdrWriter& out, const Eigen::Vector3f& colour) {
  for (const float part : colour) out.f32(part);
  out.f32(1);
}

void write_lines(CdrWriter& out, const RosHeader& header, const RosLines& lines) {
  write_header(out, header);
  out.text(lines.name).i32(0).i32(kLineList).i32(0);
  write_pose(out, SE3());
  write_vector(out, {lines.width_m, 0, 0});
  write_colour(out, lines.colour);
  out.i32(0).u32(0).u8(0);  // lifetime: for ever; not locked to its frame
  out.count(2 * lines.segments.size());
  for (const auto& [from, to] : lines.segments) {
    write_vector(out, from);
    write_vector(out, to);
  }
  out.count(0).text("");  // colours of points; texture
  write_header(out, {});
  out.text("").count(0).count(0);  // image of the texture
  out.text("").text("").text("").count(0).u8(0);
}

/// Fields of the types, without comments and constants.
const std::map<std::string_view, std::string_view>& fields_of_types() {
  static const std::map<std::string_view, std::string_view> kFields{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
      {"nav_msgs/MapMetaData",
       "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
       "geometry_msgs/Pose origin\n"},
      {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
      {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
       "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
      {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
      {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
      {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
      {"visualization_msgs/Marker",
       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
       "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n"
       "bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
       "string texture_resource\nsensor_msgs/CompressedImage texture\n"
       "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
       "visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"},
      {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"}};
  return kFields;
}

/// The types in these fields that have fields of their own, in order, each once.
void add_types(std::string_view type, std::vector<std::string>& types) {
  std::string_view fields = fields_of_types().at(type);
  for (std::size_t end = 0; (end = fields.find('\n')) != std::string_view::npos;
       fields.remove_prefix(end + 1)) {
    std::string_view of_field = fields.substr(0, fields.find(' '));
    of_field = of_field.substr(0, of_field.find('['));
    const bool is_plain = of_field.find('/') == std::string_view::npos;
    if (is_plain || std::find(types.begin(), types.end(), of_field) != types.end()) continue;
    types.emplace_back(of_field);
    add_types(of_field, types);
  }
}

}  // namespace

void write_header(CdrWriter& out, const RosHeader& header) {
  write_time(out, header.stamp);
  out.text(header.frame);
}

std::string odometry_cdr(const RosTransform& pose) {
  CdrWriter out;
  write_header(out, {pose.stamp, pose.frame});
  out.text(pose.child);
  write_pose(out, pose.pose);
  write_zeros(out, kPoseCovarianceNumbers + kTwistNumbers + kPoseCovarianceNumbers);
  return out.take();
}

std::string transforms_cdr(const std::vector<RosTransform>& transforms) {
  CdrWriter out;
  out.count(transforms.size());
  for (const RosTransform& transform : transforms) {
    write_header(out, {transform.stamp, transform.frame});
    out.text(transform.child);
    write_pose(out, transform.pose);
  }
  return out.take();
}

std::string path_cdr(const RosHeader& header, const std::vector<StampedPose<SE3>>& poses) {
  CdrWriter out;
  write_header(out, header);
  out.count(poses.size());
  for (const auto& [stamp, pose] : poses) {
    write_header(out, {stamp, header.frame});
    write_pose(out, pose);
  }
  return out.take();
}

std::string grid_cdr(const RosHeader& header, const OccupancyGrid& grid) {
  constexpr char kValues[] = {static_cast<char>(-1), 0, 100};  // by CellState
  CdrWriter out;
  write_header(out, header);
  write_time(out, header.stamp);
  out.f32(static_cast<float>(grid.cell_m));
  out.u32(static_cast<std::uint32_t>(grid.width)).u32(static_cast<std::uint32_t>(grid.height));
  write_pose(out, SE3({grid.origin_m.x(), grid.origin_m.y(), 0}, Eigen::Quaterniond::Identity()));
  std::string cells;
  for (const CellState state : grid.cells) cells += kValues[static_cast<std::size_t>(state)];
  return out.count(cells.size()).append(cells).take();
}

std::string cloud_cdr(const RosHeader& header, const std::vector<MapPoint>& points) {
  constexpr std::array kFields{"x", "y", "z", "intensity"};
  CdrWriter out;
  write_header(out, header);
  const auto count = static_cast<std::uint32_t>(points.size());
  out.u32(1).u32(count).count(kFields.size());
  std::uint32_t offset = 0;
  for (const char* field : kFields) {
    out.text(field).u32(offset).u8(kFloat32).u32(1);
    offset += sizeof(float);
  }
  out.u8(0).u32(kPointBytes).u32(kPointBytes * count).u32(kPointBytes * count);
  for (const MapPoint& point : points) {
    for (const float coordinate : point.position) out.f32(coordinate);
    out.f32(point.intensity);
  }
  return out.u8(1).take();
}

std::string lines_cdr(const RosHeader& header, const std::vector<RosLines>& lines) {
  CdrWriter out;
  out.count(lines.size());
  for (const RosLines& of_name : lines) write_lines(out, header, of_name);
  return out.take();
}

std::string ros_definition_of(std::string_view type) {
  const std::string own = short_type(type);
  std::vector<std::string> types;
  add_types(own, types);
  std::string definition(fields_of_types().at(own));
  for (const std::string& of_field : types)
    definition +=
        std::string(80, '=') + "\nMSG: " + of_field + '\n' + std::string(fields_of_types().at(of_field));
  return definition;
}

}  // namespace radioslam

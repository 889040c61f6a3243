#include "radioslam/io/mission/odometry_table.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <regex>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/named_columns.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

/// "x", "x_m", "pose_position_x", "field_pose_pose_position_x".
std::string position_form(char axis) {
  return std::string("(?:(?:.*_)?(?:position|translation|pos)_|p_?)?") + axis + "(?:_m)?";
}
std::string quaternion_form(char part) {
  return std::string("(?:(?:.*_)?(?:orientation|rotation|quaternion|quat|rot)_|q_?)") + part;
}
constexpr const char* kYawNames = "(?:.*_)?(?:yaw|theta|heading)(?:_?(?:rad|deg|degrees))?";

struct PoseColumns {
  std::size_t time = 0, x = 0, y = 0;
  std::string time_name;
  std::optional<std::size_t> z, yaw;
  std::optional<std::array<std::size_t, 4>> quaternion;
  bool is_in_degrees = false;

  explicit PoseColumns(const CsvReader& csv) {
    const NamedColumns names(csv);
    const auto found_time = names.find_time(), found_x = names.find(position_form('x')),
               found_y = names.find(position_form('y'));
    yaw = names.find(kYawNames);
    const auto qx = names.find(quaternion_form('x')), qy = names.find(quaternion_form('y')),
               qz = names.find(quaternion_form('z')), qw = names.find(quaternion_form('w'));
    if (qx && qy && qz && qw) quaternion = {*qx, *qy, *qz, *qw};
    if (!found_time || !found_x || !found_y || (!yaw && !quaternion))
      csv.fail("has no columns of a time, x, y, and yaw or a quaternion", InputError::Kind::kColumnOrder);
    time = *found_time, x = *found_x, y = *found_y;
    time_name = names.name(time);
    z = names.find(position_form('z'));
    is_in_degrees = yaw && std::regex_search(names.name(*yaw), std::regex("deg"));
  }
};

Eigen::Quaterniond rotation_in(const CsvReader& csv, const PoseColumns& columns) {
  if (!columns.quaternion)
    return so3_exp({0, 0, csv.number(*columns.yaw) * (columns.is_in_degrees ? kRadiansPerDegree : 1)});
  Eigen::Vector4d xyzw;
  for (std::size_t k = 0; k < columns.quaternion->size(); ++k)
    xyzw(static_cast<Eigen::Index>(k)) = csv.number((*columns.quaternion)[k]);
  return quaternion_in(csv.at(), xyzw, kUnitQuaternionTolerance);
}

TrajectoryRow row_in(const CsvReader& csv, const PoseColumns& columns) {
  const Eigen::Vector3d position(csv.coordinate(columns.x), csv.coordinate(columns.y),
                                 columns.z ? csv.coordinate(*columns.z) : 0);
  const Stamp stamp = time_in(csv, columns.time, columns.time_name).stamp;
  return {{stamp, SE3(position, rotation_in(csv, columns))}, csv.at().number()};
}

/// Whether the first line that is not a comment begins with a number.
bool has_no_header(const Text& text) {
  TextLines lines(text);
  if (!lines.next_with_content()) return false;
  const std::string_view line = trim(lines.line());
  return parse_number(line.substr(0, line.find_first_of(" \t,;"))).has_value();
}

}  // namespace

Trajectory<SE3> read_odometry_table(const Text& text, std::vector<std::string>& warnings) {
  if (has_no_header(text)) {
    Text tum = text;
    std::replace_if(
        tum.content.begin(), tum.content.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    return read_logged_tum(tum, warnings);
  }
  const Text readable = with_commas(text);
  CsvReader csv(readable);
  const PoseColumns columns(csv);
  std::vector<TrajectoryRow> rows;
  SkippedRecords skipped;
  bool is_row = true;
  while (is_row)
    skipped.attempt([&] {
      is_row = csv.next();
      if (is_row) rows.push_back(row_in(csv, columns));
    });
  skipped.conclude(text.name, "row", rows.size(), warnings);
  return trajectory_of_rows(text, rows, warnings);
}

}  // namespace radioslam

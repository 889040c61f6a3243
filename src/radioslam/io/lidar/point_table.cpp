#include "radioslam/io/lidar/point_table.hpp"

#include <algorithm>
#include <array>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

const PointColumn* find_column(const PointTable& table, std::string_view name) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const PointColumn& column) { return column.name == name; });
  return found == table.columns.end() ? nullptr : &*found;
}

bool is_inside(const PointTable& table, const PointColumn& column) {
  if (table.rows == 0) return true;
  const std::size_t size = bytes_of(column.type);
  if (table.bytes.size() < size || column.offset > table.bytes.size() - size) return false;
  if (column.stride == 0) return table.rows == 1;
  return table.rows - 1 <= (table.bytes.size() - size - column.offset) / column.stride;
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  switch (type) {
    case NumberType::kInt8:
    case NumberType::kUint8:
      return 1;
    case NumberType::kInt16:
    case NumberType::kUint16:
      return 2;
    case NumberType::kInt32:
    case NumberType::kUint32:
    case NumberType::kFloat32:
      return 4;
    default:
      return 8;
  }
}

bool is_time_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> kNames{"t", "time", "timestamp", "offset_time", "time_offset"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

bool is_intensity_name(std::string_view name) { return name == "intensity" || name == "reflectivity"; }

std::optional<std::string> problem_with(const PointTable& table) {
  for (const char* name : kAxes) {
    const PointColumn* column = find_column(table, name);
    if (column == nullptr) return std::string("the points have no ") + name;
    if (!is_floating(column->type)) return std::string(name) + " is not a floating-point number";
    if (!is_inside(table, *column)) return std::string("the points' ") + name + " exceed the data";
  }
  const PointColumn* time = find_time_column(table);
  if (time != nullptr && !is_inside(table, *time)) return "the points' times exceed the data";
  return std::nullopt;
}

bool is_floating(NumberType type) { return type == NumberType::kFloat32 || type == NumberType::kFloat64; }

double floating_at(const PointTable& table, const PointColumn& column, std::size_t row) {
  const ByteView view(table.bytes, table.order);
  const std::size_t at = column.offset + row * column.stride;
  return column.type == NumberType::kFloat32 ? static_cast<double>(view.f32(at)) : view.f64(at);
}

std::int64_t whole_at(const PointTable& table, const PointColumn& column, std::size_t row) {
  const ByteView view(table.bytes, table.order);
  const std::size_t at = column.offset + row * column.stride;
  switch (column.type) {
    case NumberType::kInt8:
      return view.i8(at);
    case NumberType::kUint8:
      return view.u8(at);
    case NumberType::kInt16:
      return view.i16(at);
    case NumberType::kUint16:
      return view.u16(at);
    case NumberType::kInt32:
      return view.i32(at);
    case NumberType::kUint32:
      return view.u32(at);
    default:
      return view.i64(at);
  }
}

std::vector<float> intensities_of(const PointTable& table) {
  const auto column = std::find_if(table.columns.begin(), table.columns.end(),
                                   [](const PointColumn& c) { return is_intensity_name(c.name); });
  if (column == table.columns.end() || !is_inside(table, *column)) return {};
  LidarScan scan;
  scan.intensities.resize(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row)
    scan.intensities[row] =
        static_cast<float>(is_floating(column->type) ? floating_at(table, *column, row)
                                                     : static_cast<double>(whole_at(table, *column, row)));
  forget_constant_intensities(scan);
  return std::move(scan.intensities);
}

void forget_constant_intensities(LidarScan& scan) {
  std::vector<float>& all = scan.intensities;
  const auto differs = [&](float value) { return value != all.front(); };
  if (std::none_of(all.begin(), all.end(), differs)) all.clear();
}

const PointColumn* find_time_column(const PointTable& table) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [](const PointColumn& column) { return is_time_name(column.name); });
  return found == table.columns.end() ? nullptr : &*found;
}

std::vector<Eigen::Vector3f> points_of(const PointTable& table) {
  RADIOSLAM_CHECK(!problem_with(table), "the table was checked by problem_with");
  std::vector<Eigen::Vector3f> points(table.rows);
  for (int axis = 0; axis < 3; ++axis) {
    const PointColumn& column = *find_column(table, kAxes[static_cast<std::size_t>(axis)]);
    for (std::size_t row = 0; row < table.rows; ++row)
      points[row](axis) = static_cast<float>(floating_at(table, column, row));
  }
  return points;
}

}  // namespace radioslam

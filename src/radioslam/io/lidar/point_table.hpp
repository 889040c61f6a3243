// View of points as a table of numbers with named columns, as in PCD files and PointCloud2 messages;
// point_times.hpp interprets the times.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

std::size_t bytes_of(NumberType type);

/// A column of numbers; that of row k is at offset + k * stride.
struct PointColumn {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t offset = 0;
  std::size_t stride = 0;
};

struct PointTable {
  std::string_view bytes;
  ByteOrder order = ByteOrder::kLittle;
  std::size_t rows = 0;
  std::vector<PointColumn> columns;
};

/// Whether this is a name of a column with times.
bool is_time_name(std::string_view name);

/// Error message for a table without usable points: a column x, y or z is missing, is not floating-point or
/// exceeds the data. Nothing if points_of accepts the table.
std::optional<std::string> problem_with(const PointTable& table);

/// The columns x, y and z of a table that problem_with accepts; non-finite values are kept.
std::vector<Eigen::Vector3f> points_of(const PointTable& table);

/// Whether this is a name of a column with intensities.
bool is_intensity_name(std::string_view name);

/// The intensities of a table that problem_with accepts; empty without such a column, or if all are equal.
std::vector<float> intensities_of(const PointTable& table);

/// Empties intensities that are all equal, as writers put zeros where they know none.
void forget_constant_intensities(LidarScan& scan);

/// The first column for which is_time_name holds; null if there is none.
const PointColumn* find_time_column(const PointTable& table);

bool is_floating(NumberType type);
/// A number of a floating-point column.
double floating_at(const PointTable& table, const PointColumn& column, std::size_t row);
/// A number of an integer column; unsigned 64-bit numbers are read as signed.
std::int64_t whole_at(const PointTable& table, const PointColumn& column, std::size_t row);

}  // namespace radioslam

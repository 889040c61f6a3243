// Points as a table of numbers with named columns, as PCD files and PointCloud2 messages hold them; what the
// times of points mean stands in point_times.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/byte_view.hpp"

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

/// Row k's number is at offset + k * stride.
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

/// Is this the name of a column with the points' times?
bool is_time_name(std::string_view name);

/// Why a table has no points: a column x, y or z is missing, is no column of floating-point numbers or
/// reaches beyond the bytes. Nothing for a table that points_of takes.
std::optional<std::string> refusal_of(const PointTable& table);

/// Of a table that was checked, the columns x, y and z; what is not finite stays so.
std::vector<Eigen::Vector3f> points_of(const PointTable& table);

/// The first column that is_time_name; nothing (null) where there is none.
const PointColumn* find_time_column(const PointTable& table);

bool is_floating(NumberType type);
/// The number of a column that is_floating.
double floating_at(const PointTable& table, const PointColumn& column, std::size_t row);
/// The number of one that is not; of 64 bits without a sign as if it had one.
std::int64_t whole_at(const PointTable& table, const PointColumn& column, std::size_t row);

}  // namespace radioslam

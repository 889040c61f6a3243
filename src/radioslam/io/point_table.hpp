// Points as a table of numbers with named columns, as PCD files and PointCloud2 messages hold them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/byte_view.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

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

/// The columns x, y and z; and, of the first column named t, time, timestamp, offset_time or time_offset,
/// the points' times: whole numbers are nanoseconds, others seconds. Beyond 1e6 s a time is not since the
/// scan's `stamp` but an absolute one, and then a floating-point number may be in nanoseconds as well (told
/// by 1e12 and more). What is not finite stays so.
LidarScan points_of(const PointTable& table, Stamp stamp);

}  // namespace radioslam

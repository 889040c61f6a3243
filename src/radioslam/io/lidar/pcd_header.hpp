// Parses the header of a PCD file (pcd.hpp): the fields, number and encoding of the points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/io/lidar/point_table.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// One field of a point.
struct PcdField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::string encoding;
  std::size_t data_begin = 0;  ///< byte offset in the file

  std::size_t record_bytes() const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += field.count * bytes_of(field.type);
    return bytes;
  }
};

/// Reads up to the end of the line DATA. Refuses (InputError, with the line) an invalid or inconsistent
/// header. COUNT, VERSION, VIEWPOINT and one of POINTS and WIDTH may be missing.
PcdHeader read_pcd_header(const Text& file, TextLines& lines);

}  // namespace radioslam

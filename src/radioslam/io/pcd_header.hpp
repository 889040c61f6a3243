// The header of a PCD file (pcd.hpp): what its points are made of, how many there are and how they are
// written.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/io/point_table.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// One field of every point.
struct PcdField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::string encoding;
  std::size_t data_begin = 0;  ///< byte of the file

  std::size_t record_bytes() const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += field.count * bytes_of(field.type);
    return bytes;
  }
};

/// Reads up to the end of the line DATA. Refuses (InputError, with the line) a header that says something
/// else or contradicts itself. COUNT, VERSION and VIEWPOINT may be missing, and POINTS or WIDTH.
PcdHeader read_pcd_header(const Text& file, TextLines& lines);

}  // namespace radioslam

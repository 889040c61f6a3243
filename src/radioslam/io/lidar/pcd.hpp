// Reads and writes point clouds in the PCD format, version 0.7: a text header (FIELDS, SIZE, TYPE, COUNT,
// WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA), then the points as lines of numbers (ascii), as records (binary)
// or as columns compressed with LZF (binary_compressed). VIEWPOINT is not applied.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

// Decompression of LZF, used in PCD files (binary_compressed): a byte n below 32 is followed by n + 1 literal
// bytes; any other byte encodes a copy, with the length in its upper three bits and the distance in the
// others and the next byte.

/// Decompresses the bytes; nothing if they are not LZF or do not have `size` bytes when decompressed.
/// Allocates at most 100 times the size of the input.
std::optional<std::string> decompress_lzf(std::string_view bytes, std::size_t size);

/// Reads the points' x, y and z and, where there are such fields, their times since `stamp` (point_times.hpp)
/// and intensities; other fields are skipped. Refuses (InputError) an invalid or inconsistent header, truncated data,
/// and points without coordinates.
LidarScan read_pcd(const Text& file, Stamp stamp);

/// The scan as binary PCD with the fields x y z intensity (0 if unknown), and t if the scan has times.
std::string format_pcd(const LidarScan& scan);

}  // namespace radioslam

// Point clouds in the Point Cloud Library's format, PCD v0.7: a header of lines (FIELDS, SIZE, TYPE, COUNT,
// WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA), then the points as lines of numbers (ascii), as records (binary)
// or as columns compressed with LZF (binary_compressed). VIEWPOINT is not applied.
#pragma once

#include <string>

#include "radioslam/io/text.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// The points' x, y and z, and their times where a field has them (point_table.hpp) counted from `stamp`;
/// other fields are skipped. Refuses (InputError) a header that says something else or contradicts itself,
/// data that end early, and points without coordinates.
LidarScan read_pcd(const Text& file, Stamp stamp);

/// Binary, fields x y z intensity (0), and t where the scan has times.
std::string format_pcd(const LidarScan& scan);

}  // namespace radioslam

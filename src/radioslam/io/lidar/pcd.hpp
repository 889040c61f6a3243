// Reads and writes point clouds in the PCD format, version 0.7: a text header (FIELDS, SIZE, TYPE, COUNT,
// WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA), then the points as lines of numbers (ascii), as records (binary)
// or as columns compressed with LZF (binary_compressed). VIEWPOINT is not applied.
#pragma once

#include <string>

#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// Reads the points' x, y and z and, if there is a field of times (point_times.hpp), their times since
/// `stamp`; other fields are skipped. Refuses (InputError) an invalid or inconsistent header, truncated data,
/// and points without coordinates.
LidarScan read_pcd(const Text& file, Stamp stamp);

/// The scan as binary PCD with the fields x y z intensity (0), and t if the scan has times.
std::string format_pcd(const LidarScan& scan);

}  // namespace radioslam

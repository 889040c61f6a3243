// Bytes of a scan's surfels: quantised, and compressed to 7 to 8 bytes a point.
//
//   position    in steps of 1/256 m, a fifth of a range's noise; of twice as much, and so on, where 16 bits
//               would not reach the farthest point
//   covariance  variances about its axes in steps of 10 %, the axes in steps of 0.6 degrees: normals are
//   known
//               to a few degrees
//   tilt        variance of the normal in steps of 10 %
//   densities   which points are those for registration and for coarse alignment
//
// Positions are kept as differences from one point to the next; numbers of one kind are compressed together.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "radioslam/lidar/local_map.hpp"

namespace radioslam {

/// The points of `source` and `few` must be among `all`, in the same order (scan_pyramid).
std::string packed(const ScanPyramid& cloud);

/// The quantised cloud, of bytes that packed() gave.
ScanPyramid unpacked(std::string_view bytes);
/// The same of any bytes; nothing where they are no cloud, or one of more than 65,536 points.
std::optional<ScanPyramid> unpacked_from_elsewhere(std::string_view bytes);

}  // namespace radioslam

// How many floats a point of a .bin scan has, from its numbers alone: such files have no header.
//
// If points of L floats are read as points of 4, every column holds all of the L columns in turn (for even L,
// all even or all odd ones), so that these columns have one distribution, by the Kolmogorov-Smirnov distance
// of their values; the columns of true points differ: x and y from z, and all of them from an intensity.
#pragma once

#include <cstddef>
#include <string_view>

namespace radioslam {

/// Floats of a point in files of KITTI: x y z intensity.
inline constexpr std::size_t kBinFloats = 4;

/// 3, 5, 6 or 7 if the bytes, a whole number of such points, show it as above; otherwise 4. Needs a hundred
/// points; looks at the first 2000.
std::size_t floats_per_point(std::string_view bytes);

}  // namespace radioslam

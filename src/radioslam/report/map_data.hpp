// Page data of the team's maps: occupancy grids and points.
#pragma once

#include "radioslam/geometry/se3.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// A list of {"robots", "voxel_m", "all_points", "seen_through", "scans", "grid", "points"}.
///
/// "robots" has the robots' places in the page. "grid": cell (i, j) begins at T (x0 + i cell_m, y0 + j
/// cell_m), with T = [x, y, yaw] into the page's frame, and "runs" alternate between lengths of unknown, free
/// and occupied cells, row by row from the lowest; a grid of too many cells is coarser. "points": "data" is
/// base64 of arrays of little-endian uint16, x y z and time in 65535ths from "low" to "high", then the place
/// in "robots" as uint8.
PageData map_data(const RunResult& result, const SE3& T_page_estimate, Stamp page_start);

}  // namespace radioslam

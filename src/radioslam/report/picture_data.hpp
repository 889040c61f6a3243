// Page data of a robot's occupancy image: {"cell_m", "scans", "cells", "x", "y", "yaw", "rows", "hits"}.
#pragma once

#include "radioslam/report/page_json.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Cell (i, j) is at T (i cell_m, j cell_m), T = [x, y, yaw] into the page's frame. Per row of cells, "rows"
/// contains [j, i of the first cell, increments of i to each of the others]; "hits" contains a string per row
/// with a digit per cell: 1 + floor(log2(hits)), at most 9.
PageData picture_data(const OccupancyImageResult& picture, const SE3& T_page_estimate);

}  // namespace radioslam

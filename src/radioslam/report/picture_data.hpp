// What a robot's scans show from above, on the page: {"cell_m", "scans", "cells", "x",
// "y", "yaw", "rows", "hits"}.
#pragma once

#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// Cell (i, j) lies at T (i cell_m, j cell_m), T = [x, y, yaw] into the page's frame. Per row of cells
/// "rows" has [j, i of the first, steps of i to each of the others]; "hits" a digit per cell in the same
/// order, a row's as one text: 1 + floor(log2(hits)), 9 at most.
PageData picture_data(const ScanPictureResult& picture, const SE3& T_page_estimate);

}  // namespace radioslam

// Rows of a log in the order of their times: the longest strictly increasing subsequence of their stamps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Indices of the most rows, in their order, whose times strictly increase; what a log keeps if a few rows
/// were stamped early, late or twice. Of rows with the same time, the first. O(n log n).
std::vector<std::size_t> rows_in_time_order(std::span<const Stamp> stamps);

}  // namespace radioslam

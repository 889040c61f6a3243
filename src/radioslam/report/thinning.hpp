// Thinning of data to draw: evenly spaced, first and last kept, deterministic.
#pragma once

#include <cstddef>
#include <vector>

namespace radioslam {

/// At most `limit` (at least 2) indices into `count` items, increasing, with 0 and count - 1 among them.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t limit);

/// A group's part of a budget: its whole count if the total fits, else in proportion to its size, but at
/// least `least`.
std::size_t part_of_budget(std::size_t count, std::size_t total, std::size_t budget, std::size_t least = 2);

/// Position of original index `index` among indices kept by evenly_spaced: that of the nearest one.
std::size_t nearest_kept(const std::vector<std::size_t>& kept, std::size_t index);

}  // namespace radioslam

// Which of many things to draw: evenly spaced, first and last kept, no chance involved.
#pragma once

#include <cstddef>
#include <vector>

namespace radioslam {

/// At most `limit` (at least 2) indices into `count` things, increasing, with 0 and count - 1 among them.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t limit);

/// One of several groups' share of a budget: all of it where the total fits, else in proportion to the
/// group's size, but no less than `least`.
std::size_t share_of_budget(std::size_t count, std::size_t total, std::size_t budget, std::size_t least = 2);

/// The place of original index `index` among thinned indices that came from evenly_spaced: the nearest one.
std::size_t nearest_kept(const std::vector<std::size_t>& kept, std::size_t index);

}  // namespace radioslam

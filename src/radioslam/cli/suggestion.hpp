// What a misspelled name may have meant.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace radioslam::cli {

/// Fewest insertions, deletions, substitutions and swaps of neighbours that turn one name into the other
/// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// At most three of `names` that `name` may stand for, the nearest first: a few letters off, or the same
/// last part after a point.
std::vector<std::string> nearest_names(std::string_view name, const std::vector<std::string>& names);

/// "; did you mean a, b or c?", or nothing when no name is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& names);

}  // namespace radioslam::cli

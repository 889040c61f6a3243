// Suggestions for misspelled names.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace radioslam {

/// Smallest number of insertions, deletions, substitutions and swaps of adjacent letters that turn one name
/// into the other (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Up to three of `names` that are similar to `name`, most similar first: they differ in a few letters or
/// have the same part after the last dot.
std::vector<std::string> nearest_names(std::string_view name, const std::vector<std::string>& names);

/// "; did you mean a, b or c?", or an empty string if no name is similar.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& names);

}  // namespace radioslam

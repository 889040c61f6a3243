// Rounding of the page's numbers to decimals, so that their shortest text is short.
#pragma once

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace radioslam {

// JSON of the report page: an object with the keys in the order of their insertion.

using PageData = nlohmann::ordered_json;

/// `value` with `decimals` decimals; null if it is not finite.
inline PageData rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  const double scaled = std::round(value * scale);
  if (!std::isfinite(scaled)) return value;
  return scaled / scale + 0.0;  // + 0.0: no negative zero
}

inline PageData rounded_metres(double value_m) { return rounded(value_m, 3); }
inline PageData rounded_seconds(double value_s) { return rounded(value_s, 3); }

/// `value` with six significant digits, for quantities of any size.
inline PageData rounded_relative(double value) {
  if (value == 0 || !std::isfinite(value)) return rounded(value, 0);
  return rounded(value, 5 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
}

// Thinning of data to draw: evenly spaced, first and last kept, deterministic.

/// At most `limit` (at least 2) indices into `count` items, increasing, with 0 and count - 1 among them.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t limit);

/// A group's part of a budget: its whole count if the total fits, else in proportion to its size, but at
/// least `least`.
std::size_t part_of_budget(std::size_t count, std::size_t total, std::size_t budget, std::size_t least = 2);

/// Position of original index `index` among indices kept by evenly_spaced: that of the nearest one.
std::size_t nearest_kept(const std::vector<std::size_t>& kept, std::size_t index);

}  // namespace radioslam

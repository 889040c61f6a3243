// Rounding of the page's numbers to decimals, so that their shortest text is short.
#pragma once

#include <cmath>

#include "radioslam/report/page_json.hpp"

namespace radioslam {

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

}  // namespace radioslam

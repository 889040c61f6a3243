// The normal density without its factor, as a term of mixtures with outliers.
#pragma once

#include <cmath>

namespace radioslam {

/// exp(-squared_norm / 2), or zero where that vanishes beside any probability of an outlier.
inline double unit_normal(double squared_norm) {
  constexpr double kVanishes = 80;
  return squared_norm > kVanishes ? 0 : std::exp(-0.5 * squared_norm);
}

}  // namespace radioslam

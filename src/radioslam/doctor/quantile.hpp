// Quantile of a sample.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace radioslam {

/// The value below which about this share of the others are; 0: the smallest. At least one value.
inline double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace radioslam

// The middle of a few numbers.
#pragma once

#include <algorithm>
#include <vector>

namespace radioslam {

/// The upper one of the two in the middle of an even number. Needs one value; linear in their number.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace radioslam

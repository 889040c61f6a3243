// Medians of a list of numbers, and the spread that they are robust estimates of.
#pragma once

#include <algorithm>
#include <vector>

namespace radioslam {

/// Standard deviation of a normal distribution over its median absolute deviation (MAD).
inline constexpr double kMadToSigma = 1.4826;

/// The upper one of the two in the middle of an even number. Needs one value; linear in their number.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Like upper_median, but the lower one.
inline double lower_median(std::vector<double> values) {
  const auto middle = values.begin() + (std::ssize(values) - 1) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Like upper_median, but the mean of the two.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace radioslam

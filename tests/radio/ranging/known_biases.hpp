// Range biases where the true distances are known, against which estimated ones are compared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/radio/ranging/range_bias.hpp"

namespace radioslam::test {

struct KnownRange {
  std::size_t pair = 0;
  double range_m = 0, distance_m = 0;
};

/// Huber's mean (1981), started at the median and scaled by the median deviation.
inline RangeBias known_bias(const std::vector<double>& excess_m) {
  RangeBias bias;
  bias.count = excess_m.size();
  if (excess_m.empty()) return bias;
  bias.bias_m = upper_median(excess_m);
  std::vector<double> away_m;
  for (const double excess : excess_m) away_m.push_back(std::abs(excess - bias.bias_m));
  bias.spread_m = kMadToSigma * upper_median(std::move(away_m));
  for (int step = 0; step < 50; ++step) {
    double sum = 0, weights = 0;
    for (const double excess : excess_m) {
      const double weight = std::min(1.0, 1.345 * bias.spread_m / std::abs(excess - bias.bias_m));
      sum += weight * excess, weights += weight;
    }
    bias.bias_m = sum / weights;
  }
  bias.sigma_m = bias.spread_m / std::sqrt(static_cast<double>(bias.count));
  return bias;
}

/// One per pair 0 .. pairs - 1.
inline std::vector<RangeBias> known_biases(const std::vector<KnownRange>& ranges, std::size_t pairs) {
  std::vector<std::vector<double>> excess_m(pairs);
  for (const auto& range : ranges) excess_m[range.pair].push_back(range.range_m - range.distance_m);
  std::vector<RangeBias> biases;
  for (const auto& of_pair : excess_m) biases.push_back(known_bias(of_pair));
  return biases;
}

}  // namespace radioslam::test

#include "radioslam/radio/decay_model.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

// Near 1 the logarithm vanishes and scan noise decides; near 0 the overlap is down to a few readings.
constexpr double kLeastSimilarity = 0.02;
constexpr double kMostSimilarity = 0.9;
constexpr double kLeastDistance_m = 2;

}  // namespace

double DecayModel::distance_m(double s) const { return std::max(kNearest_m, -length_m * std::log(s)); }

std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int minimum_samples) {
  std::vector<double> lengths;
  for (const auto& [similarity, distance] : samples)
    if (similarity > kLeastSimilarity && similarity < kMostSimilarity && distance > kLeastDistance_m)
      lengths.push_back(distance / -std::log(similarity));
  if (static_cast<int>(lengths.size()) < minimum_samples) return std::nullopt;
  return DecayModel{upper_median(std::move(lengths))};
}

}  // namespace radioslam

#include "radioslam/radio/fingerprints/decay_model.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

// Near 1 the logarithm vanishes and noise dominates; near 0 only a few readings overlap.
constexpr double kMinSimilarity = 0.02;
constexpr double kMaxSimilarity = 0.9;
constexpr double kMinDistance_m = 2;

}  // namespace

double DecayModel::distance_m(double s) const { return std::max(kNearest_m, -length_m * std::log(s)); }

std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int min_samples) {
  std::vector<double> lengths;
  for (const auto& [similarity, distance] : samples)
    if (similarity > kMinSimilarity && similarity < kMaxSimilarity && distance > kMinDistance_m)
      lengths.push_back(distance / -std::log(similarity));
  if (static_cast<int>(lengths.size()) < min_samples) return std::nullopt;
  return DecayModel{upper_median(std::move(lengths))};
}

}  // namespace radioslam

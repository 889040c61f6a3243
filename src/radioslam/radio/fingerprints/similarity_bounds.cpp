#include "radioslam/radio/fingerprints/similarity_bounds.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
constexpr double kRoundedSums = 1e-9;  // far above the rounding error of the sums

std::vector<double> need_weights(const Fingerprint& fingerprint, SimilarityMeasure measure,
                                 const SimilarityParams& params) {
  std::vector<double> weights;
  for (const auto& entry : fingerprint.entries) {
    const double shifted = shifted_rss_db(entry.rss_dbm);
    weights.push_back(measure == SimilarityMeasure::kCosine ? shifted * shifted
                      : measure == SimilarityMeasure::kSorensen
                          ? static_cast<double>(compared_value(entry, measure, params))
                          : 1);
  }
  return weights;
}

/// `all` is the weight of the whole fingerprint.
double min_shared(double all, double s, SimilarityMeasure measure, const SimilarityParams& params) {
  switch (measure) {
    case SimilarityMeasure::kCosine:
      return s * s * all;
    case SimilarityMeasure::kSorensen:
      return s / (2 - s) * all;
    case SimilarityMeasure::kProduct:
      return s * all <= 1 ? 1 : kImpossible;
    case SimilarityMeasure::kGeometricMean:
      return params.min_shared;
    case SimilarityMeasure::kGaussian:
    case SimilarityMeasure::kDetection:
      break;
  }
  return s * all;
}

}  // namespace

SharedWeightBound shared_weight_bound(const Fingerprint& fingerprint, double min_similarity,
                                      SimilarityMeasure measure, const SimilarityParams& params) {
  SharedWeightBound need{need_weights(fingerprint, measure, params), 0};
  const double all = std::accumulate(need.weights.begin(), need.weights.end(), 0.0);
  need.least = all > 0 ? (1 - kRoundedSums) * min_shared(all, min_similarity, measure, params) : kImpossible;
  return need;
}

std::vector<std::size_t> join_prefix(const Fingerprint& fingerprint, const SharedWeightBound& need,
                                     const std::vector<std::vector<std::uint32_t>>& holders) {
  std::vector<std::size_t> entries(fingerprint.entries.size());
  std::iota(entries.begin(), entries.end(), std::size_t{0});
  std::stable_sort(entries.begin(), entries.end(), [&](std::size_t a, std::size_t b) {
    return holders[fingerprint.entries[a].access_point.index()].size() <
           holders[fingerprint.entries[b].access_point.index()].size();
  });
  double left_out = 0;
  while (!entries.empty() && left_out + need.weights[entries.back()] < need.least) {
    left_out += need.weights[entries.back()];
    entries.pop_back();
  }
  return entries;
}

}  // namespace radioslam

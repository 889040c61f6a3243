#include "radioslam/radio/similarity_need.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "radioslam/radio/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
constexpr double kRoundedSums = 1e-9;  // far more than sums of doubles are off

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

/// `all` is what the whole fingerprint weighs.
double least_shared(double all, double s, SimilarityMeasure measure, const SimilarityParams& params) {
  switch (measure) {
    case SimilarityMeasure::kCosine:
      return s * s * all;
    case SimilarityMeasure::kSorensen:
      return s / (2 - s) * all;
    case SimilarityMeasure::kSlide:
      return s * all <= 1 ? 1 : kImpossible;
    case SimilarityMeasure::kMended:
      return params.minimum_shared;
    case SimilarityMeasure::kGaussian:
    case SimilarityMeasure::kDetection:
      break;
  }
  return s * all;
}

}  // namespace

SharedNeed shared_need(const Fingerprint& fingerprint, double least_similarity, SimilarityMeasure measure,
                       const SimilarityParams& params) {
  SharedNeed need{need_weights(fingerprint, measure, params), 0};
  const double all = std::accumulate(need.weights.begin(), need.weights.end(), 0.0);
  need.least =
      all > 0 ? (1 - kRoundedSums) * least_shared(all, least_similarity, measure, params) : kImpossible;
  return need;
}

std::vector<std::size_t> needed_prefix(const Fingerprint& fingerprint, const SharedNeed& need,
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

// How similar the team's fingerprints are: any two of them, or all pairs that reach a minimum, by the exact
// join of similarity_join.hpp. Nothing grows with the number of pairs but the time to visit those that reach
// it.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"
#include "radioslam/radio/similarity_join.hpp"

namespace radioslam {

/// The least similarity of two fingerprints that have something in common.
inline constexpr double kAnySimilarity = static_cast<double>(std::numeric_limits<float>::denorm_min());

/// Copies share what they were made of.
class TeamSimilarity {
 public:
  TeamSimilarity() : TeamSimilarity(std::vector<std::vector<float>>()) {}
  TeamSimilarity(std::vector<Fingerprint> fingerprints, SimilarityMeasure measure,
                 const SimilarityParams& params);
  /// Similarities that were measured elsewhere: symmetric, one row per fingerprint.
  explicit TeamSimilarity(std::vector<std::vector<float>> table);

  std::size_t size() const;
  /// Of fingerprints i and j.
  float of(std::size_t i, std::size_t j) const;
  /// Visits, for every i in turn, its pairs i < j that are at least `minimum` > 0 similar, ordered by j.
  void for_each_row(double minimum, const std::function<void(std::span<const SimilarPair>)>& visit) const;
  /// Visits the pairs i < j that are at least `minimum` > 0 similar, ordered by (i, j).
  void for_each_pair(double minimum, const std::function<void(const SimilarPair&)>& visit) const;

 private:
  struct Source;
  std::shared_ptr<const Source> source_;
};

}  // namespace radioslam

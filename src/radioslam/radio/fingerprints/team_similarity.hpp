// Similarities among the team's fingerprints: of any two, or of all pairs above a threshold, by the exact
// join of similarity_join.hpp. Memory does not grow with the number of pairs; time grows with those above the
// threshold. A joined one keeps its pairs, 12 bytes each, and as fingerprints come compares only what is new:
// of n among N, n N pairs.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"

namespace radioslam {

/// Threshold that every pair of positive similarity reaches.
inline constexpr double kAnySimilarity = static_cast<double>(std::numeric_limits<float>::denorm_min());

/// For every fingerprint of a list the number it had in an earlier one; nothing if it is new. Those that are
/// not keep their order.
using EarlierNumbers = std::vector<std::optional<std::size_t>>;

/// Copies share their data.
class TeamSimilarity {
 public:
  TeamSimilarity() : TeamSimilarity(std::vector<std::vector<float>>()) {}
  TeamSimilarity(std::vector<Fingerprint> fingerprints, SimilarityMeasure measure,
                 const SimilarityParams& params);
  /// From given similarities: symmetric, one row per fingerprint.
  explicit TeamSimilarity(std::vector<std::vector<float>> table);

  /// Among other fingerprints, by the same measure; absent where similarities were given.
  std::optional<TeamSimilarity> among(std::vector<Fingerprint> fingerprints) const;

  /// The same, with its pairs of similarity at least `minimum` > 0 found and kept.
  TeamSimilarity joined(double minimum) const;
  /// Among the fingerprints that are known by now, which include copies of those of `earlier` numbers in this
  /// one: as joined from nothing at the minimum of this one, which was joined.
  TeamSimilarity grown(std::vector<Fingerprint> fingerprints, const EarlierNumbers& earlier) const;
  /// The similarity from which on its pairs are kept; nothing if they are not.
  std::optional<double> joined_from() const;

  std::size_t size() const;
  /// Similarity of fingerprints i and j.
  float of(std::size_t i, std::size_t j) const;
  /// Visits, for every i in turn, its pairs i < j of similarity at least `minimum` > 0, ordered by j.
  void for_each_row(double minimum, const std::function<void(std::span<const SimilarPair>)>& visit) const;
  /// Visits the pairs i < j of similarity at least `minimum` > 0, ordered by (i, j).
  void for_each_pair(double minimum, const std::function<void(const SimilarPair&)>& visit) const;

 private:
  struct Source;
  explicit TeamSimilarity(Source source);

  std::shared_ptr<const Source> source_;
};

}  // namespace radioslam

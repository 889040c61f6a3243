// Similarity join: all pairs of fingerprints above a similarity threshold, without comparing all pairs.
//
// An exact set-similarity join for every measure: it returns exactly the pairs that reach `minimum` in
// similarity_table(), with bitwise the same values.
//   1. Length and prefix filters select the blocks (fingerprint_blocks.hpp) with
//      enough access points in common with a row.
//   2. The sums of a row with a whole block are computed over their shared columns, lane by lane and exactly
//      (similarity_lanes.hpp).
//   3. A bound on the sums selects the lanes for which the measure itself is evaluated.
// Memory: the blocks, at most 32 floats per entry and few where neighbours are alike, and the pairs of the
// requested rows. Time: 10 ns per row, selected block and shared access point (AVX2), and 20 ns per pair
// found.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/fingerprint_blocks.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"

namespace radioslam {

// Similarity bounds: how much of a fingerprint must be shared to reach a similarity, whatever the RSS. These
// are the length and prefix filters of a set-similarity join (Chaudhuri, Ganti and Kaushik 2006; Bayardo, Ma
// and Srikant 2007), weighted where the measure has weights. With s the smallest similarity and P the shared
// entries of i:
//   gaussian, detection   H >= s (H + M_i + M_j) >= s L_i
//   slide                 1 >= s (H + M_i + M_j) >= s L_i, else no fingerprint is similar; H >= 1
//   mended                H >= min_shared
//   cosine                sum_P f^2 >= s^2 sum_i f^2, by Cauchy and Schwarz
//   Sørensen              2 m >= s (G_i + G_j) and G_j >= m, m <= sum_P g: sum_P g >= s / (2 - s) G_i

/// A pair can reach the similarity only if the weights of its shared entries sum to at least `least`.
struct SharedWeightBound {
  std::vector<double> weights;  ///< per entry, >= 0
  double least = 0;             ///< infinite where no fingerprint can reach the similarity
};

/// `min_similarity` > 0. Rounding only ever lowers the bound.
SharedWeightBound shared_weight_bound(const Fingerprint& fingerprint, double min_similarity,
                                      SimilarityMeasure measure, const SimilarityParams& params);

/// Indices of entries of which a similar fingerprint has at least one: all except the most common access
/// points, whose weights together stay below the bound. `holders` lists who detects each access point.
std::vector<std::size_t> join_prefix(const Fingerprint& fingerprint, const SharedWeightBound& need,
                                     const std::vector<std::vector<std::uint32_t>>& holders);

/// Measure and threshold of a join.
struct SimilarityQuery {
  SimilarityMeasure measure = SimilarityMeasure::kSorensen;
  SimilarityParams params;
  double minimum = 0;  ///< smallest similarity; 0 or less returns every pair, dissimilar ones included
};

/// Similarity of fingerprint `i` of the rows with `j` of the columns.
struct SimilarPair {
  std::uint32_t i = 0, j = 0;
  float similarity = 0;

  auto operator<=>(const SimilarPair&) const = default;
};

/// Refers to the fingerprints that it is constructed from; they must outlive it.
class SimilarityJoin {
 public:
  /// Pairs i < j within one recording.
  static SimilarityJoin within(const std::vector<Fingerprint>& fingerprints, const SimilarityQuery& query);
  /// Pairs of fingerprints of two recordings.
  static SimilarityJoin between(const std::vector<Fingerprint>& rows, const std::vector<Fingerprint>& columns,
                                const SimilarityQuery& query);

  std::size_t rows() const { return rows_->size(); }
  std::size_t columns() const { return columns_->size(); }
  /// Pairs with i in [begin, end), ordered by (i, j). Thread-safe; most efficient for multiples of
  /// kRowsTogether consecutive rows.
  std::vector<SimilarPair> pairs_of(std::size_t begin, std::size_t end) const;
  /// All pairs, ordered; uses all threads. For very many pairs, prefer pairs_of() over ranges of rows.
  std::vector<SimilarPair> pairs() const;

  static constexpr std::size_t kRowsTogether = 32;

 private:
  SimilarityJoin(const std::vector<Fingerprint>& rows, const std::vector<Fingerprint>& columns,
                 const SimilarityQuery& query);
  std::vector<SimilarPair> reaching_pairs_of(std::size_t begin, std::size_t end) const;
  /// Adds the pairs of similarity 0.
  std::vector<SimilarPair> with_zeros(const std::vector<SimilarPair>& pairs, std::size_t begin,
                                      std::size_t end) const;
  std::size_t first_column(std::size_t row) const { return rows_ == columns_ ? row + 1 : 0; }

  const std::vector<Fingerprint>* rows_;
  const std::vector<Fingerprint>* columns_;
  SimilarityQuery query_;
  FingerprintBlocks blocks_;
};

}  // namespace radioslam

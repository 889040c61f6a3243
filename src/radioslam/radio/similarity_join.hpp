// All pairs of fingerprints that are at least so similar, without looking at all pairs: an exact
// set-similarity join for every measure. It gives the very floats of similarity_table(), and of the pairs
// exactly those that reach `minimum` there.
//   1. Length and prefix filters (similarity_need.hpp) leave, of the blocks of fingerprints of one place
//      (fingerprint_blocks.hpp), those that hear enough of what a fingerprint heard.
//   2. The sums of a fingerprint with a whole block come from the columns that both have, lane by lane and
//      exactly (similarity_lanes.hpp).
//   3. A bound on the sums leaves the lanes that take the roots and exponentials of the measure.
// Memory: the blocks, at most 32 floats for an entry and a few where neighbours hear much the same, and the
// pairs of the rows asked for. Time: 10 ns for a fingerprint, a block that step 1 leaves and an access point
// that both have (AVX2), and 20 ns for a pair found.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/fingerprint_blocks.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam {

/// Which pairs count.
struct SimilarityQuery {
  SimilarityMeasure measure = SimilarityMeasure::kSorensen;
  SimilarityParams params;
  double minimum = 0;  ///< least similarity; 0 or less: every pair, those with nothing in common too
};

/// Fingerprint `i` of the rows and `j` of the columns.
struct SimilarPair {
  std::uint32_t i = 0, j = 0;
  float similarity = 0;

  auto operator<=>(const SimilarPair&) const = default;
};

/// Holds on to the fingerprints that it was made of: they must outlive it.
class SimilarityJoin {
 public:
  /// Every pair of one recording, i < j.
  static SimilarityJoin within(const std::vector<Fingerprint>& fingerprints, const SimilarityQuery& query);
  /// Every fingerprint of one recording with every one of another.
  static SimilarityJoin between(const std::vector<Fingerprint>& rows, const std::vector<Fingerprint>& columns,
                                const SimilarityQuery& query);

  std::size_t rows() const { return rows_->size(); }
  std::size_t columns() const { return columns_->size(); }
  /// Pairs whose i is in [begin, end), ordered by (i, j). May be called from several threads; best for
  /// kRowsTogether rows that follow each other.
  std::vector<SimilarPair> pairs_of(std::size_t begin, std::size_t end) const;
  /// All pairs, ordered, on all threads. Where they could be very many, ask for some rows at a time.
  std::vector<SimilarPair> pairs() const;

  static constexpr std::size_t kRowsTogether = 32;

 private:
  SimilarityJoin(const std::vector<Fingerprint>& rows, const std::vector<Fingerprint>& columns,
                 const SimilarityQuery& query);
  std::vector<SimilarPair> reaching_pairs_of(std::size_t begin, std::size_t end) const;
  /// Adds the pairs with nothing in common.
  std::vector<SimilarPair> with_zeros(const std::vector<SimilarPair>& pairs, std::size_t begin,
                                      std::size_t end) const;
  std::size_t first_column(std::size_t row) const { return rows_ == columns_ ? row + 1 : 0; }

  const std::vector<Fingerprint>* rows_;
  const std::vector<Fingerprint>* columns_;
  SimilarityQuery query_;
  FingerprintBlocks blocks_;
};

}  // namespace radioslam

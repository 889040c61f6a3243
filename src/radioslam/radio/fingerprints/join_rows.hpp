// One task of the similarity join (similarity_join.hpp): joins up to one fingerprint per bit of RowBits with
// all blocks. Successive rows of a recording need the same blocks, whose columns then stay in the cache.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint_blocks.hpp"
#include "radioslam/radio/fingerprints/similarity_bounds.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"
#include "radioslam/radio/fingerprints/similarity_lanes.hpp"

namespace radioslam {

/// One bit per row.
using RowBits = std::uint32_t;

enum class JoinedPairs {
  kAll,
  kLaterOnes,  ///< a recording with itself: only j > i
};

/// Matches of a row in one slab: a similarity per lane, and which lanes have one.
struct SlabMatches {
  std::vector<float> similarity = std::vector<float>(kSlabLanes);
  std::vector<std::uint64_t> has = std::vector<std::uint64_t>(kSlabLanes / 64);
};

class JoinedRows {
 public:
  /// `query.minimum` > 0.
  JoinedRows(const FingerprintBlocks& blocks, const SimilarityQuery& query, JoinedPairs which);
  void add(const Fingerprint& row, std::uint32_t index);
  /// Pairs of all rows, ordered; `columns` are the fingerprints in the blocks.
  std::vector<SimilarPair> pairs(const std::vector<Fingerprint>& columns);

 private:
  struct Row {
    const Fingerprint* fingerprint;
    std::uint32_t index;
    SharedWeightBound need;
    FingerprintTotals totals;
    LaneQuery query;
    std::vector<std::uint32_t> local;  ///< per entry: its access point's index among those of all rows
    std::vector<float> values;         ///< per entry: compared_value()
    SlabMatches matches;
    std::vector<SimilarPair> pairs;
  };

  LaneQuery lane_query(const FingerprintTotals& totals) const;
  std::uint32_t local_of(AccessPointIndex access_point);
  void want_blocks();
  void join_slab(std::size_t slab);
  void join_block(std::size_t b);
  void compare(Row& row, const FingerprintBlock& block);
  LaneBits allowed_lanes(const Row& row, const FingerprintBlock& block) const;
  void accept(Row& row, const FingerprintBlock& block, std::size_t lane, const LaneSums& sums);
  void collect(Row& row, std::size_t slab);

  const FingerprintBlocks* blocks_;
  SimilarityQuery query_;
  JoinedPairs which_;
  SimilarityKernel kernel_;
  const std::vector<Fingerprint>* columns_ = nullptr;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> locals_;    ///< per access point: its local index, 0 if no row has it
  std::vector<AccessPointIndex> heard_;  ///< per local index
  std::vector<RowBits> wanting_;         ///< per local index: rows with it in their prefix
  std::vector<RowBits> wanted_;          ///< per block: rows that may have a match in it
  std::vector<const float*> column_;     ///< per local index: column of the current block, or null
  std::vector<SharedColumn> shared_columns_;
};

}  // namespace radioslam

// Some fingerprints, at most one per bit of RowBits, joined with all blocks: what similarity_join.hpp does
// for the rows of one task. Rows that follow each other in a recording meet the same blocks, and a block's
// columns are then in the fast memory for all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprint_blocks.hpp"
#include "radioslam/radio/similarity_join.hpp"
#include "radioslam/radio/similarity_lanes.hpp"
#include "radioslam/radio/similarity_need.hpp"

namespace radioslam {

/// One bit per row.
using RowBits = std::uint32_t;

enum class JoinedPairs {
  kAll,
  kLaterOnes,  ///< of one recording with itself: only j > i
};

/// What is found of a row in one slab: a value per lane and which lanes have one.
struct SlabFinds {
  std::vector<float> similarity = std::vector<float>(kSlabLanes);
  std::vector<std::uint64_t> has = std::vector<std::uint64_t>(kSlabLanes / 64);
};

class JoinedRows {
 public:
  /// `query.minimum` > 0.
  JoinedRows(const FingerprintBlocks& blocks, const SimilarityQuery& query, JoinedPairs which);
  void add(const Fingerprint& row, std::uint32_t index);
  /// The pairs of all rows, ordered; `columns` are the fingerprints in the blocks.
  std::vector<SimilarPair> pairs(const std::vector<Fingerprint>& columns);

 private:
  struct Row {
    const Fingerprint* fingerprint;
    std::uint32_t index;
    SharedNeed need;
    FingerprintTotals totals;
    LaneQuery query;
    std::vector<std::uint32_t> local;  ///< per entry, its access point among those of all rows
    std::vector<float> values;         ///< per entry
    SlabFinds finds;
    std::vector<SimilarPair> pairs;
  };

  LaneQuery lane_query(const FingerprintTotals& totals) const;
  std::uint32_t local_of(AccessPointIndex access_point);
  void want_blocks();
  void join_slab(std::size_t slab);
  void join_block(std::size_t b);
  void meet(Row& row, const FingerprintBlock& block);
  LaneBits allowed_lanes(const Row& row, const FingerprintBlock& block) const;
  void take(Row& row, const FingerprintBlock& block, std::size_t lane, const LaneSums& sums);
  void collect(Row& row, std::size_t slab);

  const FingerprintBlocks* blocks_;
  SimilarityQuery query_;
  JoinedPairs which_;
  SimilarityKernel kernel_;
  const std::vector<Fingerprint>* columns_ = nullptr;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> locals_;    ///< per access point; 0: no row hears it
  std::vector<AccessPointIndex> heard_;  ///< per local
  std::vector<RowBits> wanting_;         ///< per local: rows with it in their prefix
  std::vector<RowBits> wanted_;          ///< per block: rows that may find something there
  std::vector<const float*> column_;     ///< per local, in the block at hand; null where it has none
  std::vector<MetColumn> met_;
};

}  // namespace radioslam

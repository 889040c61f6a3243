// Fingerprints side by side, spread out by access point: what one fingerprint shares with a whole block of
// them is then a walk over columns of numbers. Only access points that somebody in the block hears have a
// column, so a block of fingerprints of one place is small, and a fingerprint of another place shares few
// columns with it or none. For that, neighbours in a block hear the same access points strongest, however the
// recording was ordered; a block never leaves its slab, a stretch of the recording.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity_lanes.hpp"
#include "radioslam/radio/similarity_sums.hpp"

namespace radioslam {

/// Blocks that a slab's fingerprints fill.
inline constexpr std::size_t kBlocksPerSlab = 256, kSlabLanes = kBlocksPerSlab * kLanes;

struct FingerprintBlock {
  std::vector<std::uint32_t> fingerprints;      ///< at most kLanes, one per lane, ascending
  std::vector<AccessPointIndex> access_points;  ///< of the columns, ascending
  std::vector<float> values;                    ///< columns x kLanes, compared_value() or kUnheardValue
  std::vector<FingerprintTotals> totals;        ///< per lane
  LaneTotals lanes;

  const float* column(std::size_t c) const { return &values[c * kLanes]; }
};

struct FingerprintBlocks {
  std::vector<FingerprintBlock> blocks;             ///< slab by slab, kBlocksPerSlab each but for the last
  std::vector<std::vector<std::uint32_t>> holders;  ///< per access point: the blocks that hear it, ascending
};

/// Linear in the entries but for the sorting; on all threads.
FingerprintBlocks fingerprint_blocks(const std::vector<Fingerprint>& fingerprints, std::size_t access_points,
                                     SimilarityMeasure measure, const SimilarityParams& params);

}  // namespace radioslam

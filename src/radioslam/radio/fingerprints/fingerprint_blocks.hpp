// Blocks of fingerprints in columns by access point: the memory layout over which one fingerprint is compared
// with many at once. Only access points detected in the block have a column, so blocks of one place are
// small, and fingerprints of other places share few columns with them. To this end the fingerprints of a slab
// (a part of the recording) are reordered so that neighbours detect the same access points; a block never
// spans two slabs.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity_lanes.hpp"
#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {

/// Blocks and fingerprints per slab.
inline constexpr std::size_t kBlocksPerSlab = 256, kSlabLanes = kBlocksPerSlab * kLanes;

struct FingerprintBlock {
  std::vector<std::uint32_t> fingerprints;      ///< at most kLanes, one per lane, ascending
  std::vector<AccessPointIndex> access_points;  ///< one per column, ascending
  std::vector<float> values;                    ///< columns x kLanes, compared_value() or kUndetectedValue
  std::vector<FingerprintTotals> totals;        ///< per lane
  LaneTotals lanes;

  const float* column(std::size_t c) const { return &values[c * kLanes]; }
};

struct FingerprintBlocks {
  std::vector<FingerprintBlock> blocks;             ///< slab by slab, kBlocksPerSlab each except in the last
  std::vector<std::vector<std::uint32_t>> holders;  ///< per access point: blocks that detect it, ascending
};

/// Linear in the entries except for sorting; uses all threads.
FingerprintBlocks fingerprint_blocks(const std::vector<Fingerprint>& fingerprints, std::size_t access_points,
                                     SimilarityMeasure measure, const SimilarityParams& params);

}  // namespace radioslam

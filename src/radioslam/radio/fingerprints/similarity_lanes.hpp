// Inner loops of the similarity join: sums of one fingerprint with a block of others, one per lane, and a
// bound on which lanes can reach the similarity. A lane adds the same double-precision terms in the same
// order as a pass over the two fingerprints, without fused multiply-add, so the sums are the same bytes on
// every machine. There is one kernel per instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "radioslam/radio/fingerprints/similarity.hpp"

namespace radioslam {

inline constexpr std::size_t kLanes = 32;  ///< fingerprints in a block

/// Value of an access point that a lane does not detect, in place of its RSS in dBm; shifted RSS and g are 0.
inline constexpr float kUndetectedValue = -std::numeric_limits<float>::infinity();

/// An access point that the fingerprint and the block share.
struct SharedColumn {
  const float* values;  ///< per lane: RSS in dBm or kUndetectedValue; Sørensen: g or 0
  float own;            ///< value of the fingerprint
};

/// SharedSums of every lane; `shared` is counted where the measure needs it.
struct LaneSums {
  alignas(32) std::array<double, kLanes> sum;
  alignas(32) std::array<double, kLanes> shared;
};

/// FingerprintTotals of every lane; zero for unused lanes.
struct LaneTotals {
  alignas(32) std::array<double, kLanes> heard{};           ///< number of access points
  alignas(32) std::array<double, kLanes> total{};           ///< see FingerprintTotals
  alignas(32) std::array<double, kLanes> min_detection2{};  ///< smallest tau^2
};

/// Totals and thresholds of the fingerprint that a block is compared with.
struct LaneQuery {
  double least = 0;  ///< smallest similarity, > 0
  double heard = 0, total = 0, min_detection2 = 0;
  double per_db2 = 0;         ///< 1 / (2 sigma_r^2)
  double per_detection2 = 0;  ///< 1 / (2 sigma_tau^2); 0 except for the detection measure
  double min_shared = 0;
};

/// One bit per lane.
using LaneBits = std::uint32_t;

/// `sum` computes LaneSums; `reaching` is conservative: a lane without its bit is certainly below `least`. It
/// bounds exponentials by exp(x) >= 1 + x + x^2/2 + x^3/6 + x^4/24, x >= 0.
struct SimilarityKernel {
  void (*sum)(const SharedColumn* columns, std::size_t count, LaneSums& sums);
  LaneBits (*reaching)(const LaneSums& sums, const LaneTotals& lanes, const LaneQuery& query);
};

/// Fastest kernel that this machine supports.
SimilarityKernel similarity_kernel(SimilarityMeasure measure);

SimilarityKernel similarity_kernel_sse2(SimilarityMeasure measure);
SimilarityKernel similarity_kernel_avx2(SimilarityMeasure measure);  ///< x86-64 with AVX2 only

}  // namespace radioslam

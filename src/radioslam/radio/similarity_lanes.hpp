// The inner loops of a similarity join: the sums of one fingerprint with a block of others, one per lane, and
// which lanes may be similar enough. A lane adds the same double-precision terms in the same order as a walk
// over the two fingerprints, single multiplications and additions, never fused: the sums are the same bytes
// on every machine. There is one kernel per instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "radioslam/radio/similarity.hpp"

namespace radioslam {

inline constexpr std::size_t kLanes = 32;  ///< fingerprints in a block

/// In place of the RSS in dBm of an access point that a lane does not hear. Shifted RSS and g are 0 there.
inline constexpr float kUnheardValue = -std::numeric_limits<float>::infinity();

/// An access point that the fingerprint and the block both hear.
struct MetColumn {
  const float* values;  ///< per lane: RSS in dBm or kUnheardValue; Sørensen: g or 0
  float own;            ///< the fingerprint's
};

/// SharedSums of every lane; `shared` is counted where the measure needs it.
struct LaneSums {
  alignas(32) std::array<double, kLanes> sum;
  alignas(32) std::array<double, kLanes> shared;
};

/// What every lane's fingerprint brings; lanes without one hear nothing.
struct LaneTotals {
  alignas(32) std::array<double, kLanes> heard{};             ///< access points
  alignas(32) std::array<double, kLanes> total{};             ///< see FingerprintTotals
  alignas(32) std::array<double, kLanes> least_detection2{};  ///< its smallest tau^2
};

/// A fingerprint that looks for others.
struct LaneQuery {
  double least = 0;  ///< similarity that counts, > 0
  double heard = 0, total = 0, least_detection2 = 0;
  double per_db2 = 0;         ///< 1 / (2 sigma_r^2)
  double per_detection2 = 0;  ///< 1 / (2 sigma_tau^2); 0 for other measures than detection
  double minimum_shared = 0;
};

/// One bit per lane.
using LaneBits = std::uint32_t;

/// Bounds that never exceed a similarity's true side: a lane without its bit is less alike than `least`.
/// For exponents they use exp(x) >= 1 + x + x^2/2 + x^3/6 + x^4/24, x >= 0.
struct SimilarityKernel {
  void (*sum)(const MetColumn* columns, std::size_t count, LaneSums& sums);
  LaneBits (*reaching)(const LaneSums& sums, const LaneTotals& lanes, const LaneQuery& query);
};

/// The fastest kernel that this machine can run.
SimilarityKernel similarity_kernel(SimilarityMeasure measure);

SimilarityKernel similarity_kernel_narrow(SimilarityMeasure measure);
SimilarityKernel similarity_kernel_wide(SimilarityMeasure measure);  ///< x86-64 with AVX2 only

}  // namespace radioslam

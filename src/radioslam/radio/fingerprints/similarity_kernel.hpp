// Kernels of similarity_lanes.hpp in the compiler's vectors of four doubles; a source file compiled for wider
// registers gets wider code. Included only by the source files per instruction set.
#pragma once

#include "radioslam/radio/fingerprints/similarity_lanes.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kAtOnce = 4;  // lanes in a vector

using FourDoubles = double __attribute__((vector_size(32)));
using FourLongs = std::int64_t __attribute__((vector_size(32)));

inline FourDoubles load_lanes(const double* p) {
  FourDoubles v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

inline FourDoubles in_all(double x) { return FourDoubles{x, x, x, x}; }
/// Element by element: g++ 12 compiles this to one instruction, __builtin_convertvector to five.
inline FourDoubles load_doubles(const float* p) {
  return FourDoubles{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]),
                     static_cast<double>(p[3])};
}

inline FourDoubles shifted_values(FourDoubles rss_dbm) {
  const FourDoubles shifted = rss_dbm + in_all(100);
  return shifted > in_all(0) ? shifted : in_all(0);
}

struct AddProducts {
  FourDoubles own;
  explicit AddProducts(float value) : own(shifted_values(in_all(static_cast<double>(value)))) {}
  void operator()(FourDoubles values, FourDoubles& sum, FourDoubles& /*shared*/) const {
    sum += own * shifted_values(values);
  }
};

struct AddMinima {
  FourDoubles own;
  explicit AddMinima(float value) : own(in_all(static_cast<double>(value))) {}
  void operator()(FourDoubles values, FourDoubles& sum, FourDoubles& /*shared*/) const {
    sum += values < own ? values : own;
  }
};

struct AddSquares {
  FourDoubles own;
  explicit AddSquares(float value) : own(in_all(static_cast<double>(value))) {}
  /// Lanes without the access point contribute a difference of zero.
  void operator()(FourDoubles values, FourDoubles& sum, FourDoubles& shared) const {
    const FourLongs heard = values > in_all(static_cast<double>(kUndetectedValue));
    const FourDoubles d = heard ? values - own : in_all(0);
    sum += d * d;
    shared += heard ? in_all(1) : in_all(0);
  }
};

/// Sums over the shared columns, few enough lanes at a time for the registers.
template <class Add>
void sum_lanes(const SharedColumn* columns, std::size_t count, LaneSums& sums) {
  constexpr std::size_t kVectors = 4, kPart = kVectors * kAtOnce;
  for (std::size_t begin = 0; begin < kLanes; begin += kPart) {
    FourDoubles sum[kVectors], shared[kVectors];
    for (std::size_t k = 0; k < kVectors; ++k) sum[k] = shared[k] = in_all(0);
    for (const SharedColumn* column = columns; column != columns + count; ++column) {
      const Add add(column->own);
      for (std::size_t k = 0; k < kVectors; ++k)
        add(load_doubles(column->values + begin + k * kAtOnce), sum[k], shared[k]);
    }
    for (std::size_t k = 0; k < kVectors; ++k) {
      __builtin_memcpy(&sums.sum[begin + k * kAtOnce], &sum[k], sizeof sum[k]);
      __builtin_memcpy(&sums.shared[begin + k * kAtOnce], &shared[k], sizeof shared[k]);
    }
  }
}

/// Lower bound on exp(x) for x >= 0.
inline FourDoubles exp_at_most(FourDoubles x) {
  return in_all(1) + x * (in_all(1) + x * (in_all(1.0 / 2) + x * (in_all(1.0 / 6) + x * in_all(1.0 / 24))));
}

/// Inputs of a test for four lanes.
struct TestedLanes {
  FourDoubles sum, shared, heard, total, min_detection2;
};

inline TestedLanes tested_lanes(const LaneSums& sums, const LaneTotals& lanes, std::size_t k) {
  return {load_lanes(&sums.sum[k]), load_lanes(&sums.shared[k]), load_lanes(&lanes.heard[k]),
          load_lanes(&lanes.total[k]), load_lanes(&lanes.min_detection2[k])};
}

/// s^2 >= least^2
struct CosineTest {
  static FourLongs passes(const TestedLanes& lanes, const LaneQuery& query) {
    return lanes.sum * lanes.sum >= in_all(query.least * query.least * query.total) * lanes.total;
  }
};

struct SorensenTest {
  static FourLongs passes(const TestedLanes& lanes, const LaneQuery& query) {
    return in_all(2) * lanes.sum >= in_all(query.least) * (in_all(query.total) + lanes.total);
  }
};

/// Also for the Gaussian measure, in which unshared access points have no weight.
struct DetectionTest {
  static FourLongs passes(const TestedLanes& lanes, const LaneQuery& query) {
    const FourDoubles alone = (in_all(query.heard) - lanes.shared) * in_all(query.min_detection2) +
                              (lanes.heard - lanes.shared) * lanes.min_detection2;
    const FourDoubles inverse = exp_at_most(in_all(query.per_db2) * lanes.sum / lanes.shared) *
                                exp_at_most(in_all(query.per_detection2) * alone);
    const FourDoubles heard = in_all(query.heard) + lanes.heard - lanes.shared;
    return lanes.shared >= in_all(query.least) * heard * inverse;  // false where nothing is shared: 0/0
  }
};

struct SlideTest {
  static FourLongs passes(const TestedLanes& lanes, const LaneQuery& query) {
    const FourDoubles heard = in_all(query.heard) + lanes.heard - lanes.shared;
    return in_all(1) >= in_all(query.least) * heard * exp_at_most(in_all(query.per_db2) * lanes.sum);
  }
};

struct MendedTest {
  static FourLongs passes(const TestedLanes& lanes, const LaneQuery& query) {
    const FourDoubles inverse = exp_at_most(in_all(query.per_db2) * lanes.sum / lanes.shared);
    return (lanes.shared >= in_all(query.min_shared)) & (in_all(1) >= in_all(query.least) * inverse);
  }
};

template <class Test>
LaneBits reaching_lanes(const LaneSums& sums, const LaneTotals& lanes, const LaneQuery& query) {
  FourLongs bits = {}, bit = {1, 2, 4, 8};
  for (std::size_t k = 0; k < kLanes; k += kAtOnce, bit <<= kAtOnce)
    bits |= Test::passes(tested_lanes(sums, lanes, k), query) & bit;
  return static_cast<LaneBits>(bits[0] | bits[1] | bits[2] | bits[3]);
}

SimilarityKernel kernel_of(SimilarityMeasure measure) {
  switch (measure) {
    case SimilarityMeasure::kCosine:
      return {&sum_lanes<AddProducts>, &reaching_lanes<CosineTest>};
    case SimilarityMeasure::kSorensen:
      return {&sum_lanes<AddMinima>, &reaching_lanes<SorensenTest>};
    case SimilarityMeasure::kProduct:
      return {&sum_lanes<AddSquares>, &reaching_lanes<SlideTest>};
    case SimilarityMeasure::kGeometricMean:
      return {&sum_lanes<AddSquares>, &reaching_lanes<MendedTest>};
    case SimilarityMeasure::kGaussian:
    case SimilarityMeasure::kDetection:
      break;
  }
  return {&sum_lanes<AddSquares>, &reaching_lanes<DetectionTest>};
}

}  // namespace
}  // namespace radioslam

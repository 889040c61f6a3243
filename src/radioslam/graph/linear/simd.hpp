// The vectors the dense kernels are written in. Only single multiplications, additions and subtractions,
// never fused: every width gives the same bytes.
#pragma once

#include <cstddef>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace radioslam::dense {

/// Two doubles: what every 64-bit machine has.
struct TwoDoubles {
  static constexpr std::size_t kWidth = 2;
  using Vector = double __attribute__((vector_size(16)));
  using Count = std::size_t;

  static Vector broadcast(double x) { return Vector{x, x}; }
  static Vector load(const double* p) { return Vector{p[0], p[1]}; }
  static Vector load_first(const double* p, Count count) { return Vector{p[0], count > 1 ? p[1] : 0}; }
  static void store(double* p, Vector v) {
    p[0] = v[0];
    p[1] = v[1];
  }
  static void store_first(double* p, Count count, Vector v) {
    p[0] = v[0];
    if (count > 1) p[1] = v[1];
  }
};

#ifdef __AVX2__
/// Four doubles, for source files compiled for AVX2.
struct FourDoubles {
  static constexpr std::size_t kWidth = 4;
  using Vector = __m256d;
  /// A mask over the vector.
  struct Count {
    Count(std::size_t count)
        : mask(_mm256_cmpgt_epi64(_mm256_set1_epi64x(static_cast<long long>(count)),
                                  _mm256_set_epi64x(3, 2, 1, 0))) {}
    __m256i mask;
  };

  static Vector broadcast(double x) { return _mm256_set1_pd(x); }
  static Vector load(const double* p) { return _mm256_loadu_pd(p); }
  static Vector load_first(const double* p, Count count) { return _mm256_maskload_pd(p, count.mask); }
  static void store(double* p, Vector v) { _mm256_storeu_pd(p, v); }
  static void store_first(double* p, Count count, Vector v) { _mm256_maskstore_pd(p, count.mask, v); }
};
#endif

}  // namespace radioslam::dense

#include "radioslam/radio/fingerprints/similarity_lanes.hpp"

namespace radioslam {

SimilarityKernel similarity_kernel(SimilarityMeasure measure) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return similarity_kernel_avx2(measure);
#endif
  return similarity_kernel_sse2(measure);
}

}  // namespace radioslam

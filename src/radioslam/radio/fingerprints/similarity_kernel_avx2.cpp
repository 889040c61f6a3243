// Compiled for AVX2 on x86-64; see room.cmake.
#ifdef __AVX2__
#include "radioslam/radio/fingerprints/similarity_kernel.hpp"

namespace radioslam {

SimilarityKernel similarity_kernel_avx2(SimilarityMeasure measure) { return kernel_of(measure); }

}  // namespace radioslam
#endif

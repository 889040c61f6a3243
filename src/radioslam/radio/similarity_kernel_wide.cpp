// Compiled for AVX2 where the processor family has it; see room.cmake.
#ifdef __AVX2__
#include "radioslam/radio/similarity_kernel.hpp"

namespace radioslam {

SimilarityKernel similarity_kernel_wide(SimilarityMeasure measure) { return kernel_of(measure); }

}  // namespace radioslam
#endif

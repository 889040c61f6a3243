#include "radioslam/radio/fingerprints/similarity_kernel.hpp"

namespace radioslam {

SimilarityKernel similarity_kernel_sse2(SimilarityMeasure measure) { return kernel_of(measure); }

}  // namespace radioslam

#include "radioslam/radio/similarity_kernel.hpp"

namespace radioslam {

SimilarityKernel similarity_kernel_narrow(SimilarityMeasure measure) { return kernel_of(measure); }

}  // namespace radioslam

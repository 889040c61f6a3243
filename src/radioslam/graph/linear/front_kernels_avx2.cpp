// Kernels for AVX2. This file alone is compiled for it, so nothing that other files could share may be here.
#include "radioslam/graph/linear/dense_front.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"
#include "radioslam/graph/linear/simd.hpp"

namespace radioslam {

#ifdef __AVX2__
FrontKernels front_kernels_four_doubles() {
  return dense::DenseFront<dense::FourDoubles>::kernels("four doubles (AVX2)");
}
#endif

}  // namespace radioslam

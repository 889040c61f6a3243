// Kernels for any 64-bit machine.
#include "radioslam/graph/linear/dense_front.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"
#include "radioslam/graph/linear/simd.hpp"

namespace radioslam {

FrontKernels front_kernels_two_doubles() {
  return dense::DenseFront<dense::TwoDoubles>::kernels("two doubles");
}

}  // namespace radioslam

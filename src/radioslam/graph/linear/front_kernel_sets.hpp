// The sets of kernels this program was built with.
#pragma once

#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {

FrontKernels front_kernels_two_doubles();
FrontKernels front_kernels_four_doubles();  ///< x86-64 only

}  // namespace radioslam

#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {

std::vector<FrontKernels> available_front_kernels() {
  std::vector<FrontKernels> kernels;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) kernels.push_back(front_kernels_four_doubles());
#endif
  kernels.push_back(front_kernels_two_doubles());
  return kernels;
}

const FrontKernels& front_kernels() {
  static const FrontKernels kFastest = available_front_kernels().front();
  return kFastest;
}

}  // namespace radioslam

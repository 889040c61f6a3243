// Compiled for AVX2 on x86-64; see room.cmake.
#ifdef __AVX2__
#include "radioslam/radio/aoa/beam_kernel.hpp"

namespace radioslam {

BeamKernel beam_kernel_avx2() { return &sum_beams; }

OppositeBeamKernel opposite_beam_kernel_avx2() { return &sum_opposite_beams; }

}  // namespace radioslam
#endif

// Compiled for AVX2 where the processor family has it; see room.cmake.
#ifdef __AVX2__
#include "radioslam/radio/beam_kernel.hpp"

namespace radioslam {

BeamKernel beam_kernel_wide() { return &sum_beams; }

OppositeBeamKernel opposite_beam_kernel_wide() { return &sum_opposite_beams; }

}  // namespace radioslam
#endif

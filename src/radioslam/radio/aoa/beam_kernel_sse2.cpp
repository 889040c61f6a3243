#include "radioslam/radio/aoa/beam_kernel.hpp"

namespace radioslam {

BeamKernel beam_kernel_sse2() { return &sum_beams; }

OppositeBeamKernel opposite_beam_kernel_sse2() { return &sum_opposite_beams; }

}  // namespace radioslam

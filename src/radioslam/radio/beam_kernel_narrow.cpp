#include "radioslam/radio/beam_kernel.hpp"

namespace radioslam {

BeamKernel beam_kernel_narrow() { return &sum_beams; }

OppositeBeamKernel opposite_beam_kernel_narrow() { return &sum_opposite_beams; }

}  // namespace radioslam

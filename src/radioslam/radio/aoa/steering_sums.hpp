// Steering sums, the inner loop of every profile: correlation of signals with the waves from many sources,
//   z_r = sum_k y_kr exp(j kappa e(p_k)).
// Single precision, with one kernel per instruction set. All kernels keep eight partial sums whatever the
// register width and use no fused multiply-add, so every machine gives the same bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam {

/// Signals over the snapshots of an array in the kernel's memory layout; padded by snapshots of zeros.
struct BeamInput {
  std::size_t padded = 0;                        ///< snapshots, a multiple of eight
  std::size_t signals = 0;                       ///< at most kMaxSignals
  std::vector<float> x_turns, y_turns, z_turns;  ///< kappa p/(2 pi)
  std::vector<float> square_turns;               ///< kappa |p|^2/(2 pi), per metre
  std::vector<float> real, imaginary;            ///< signals x padded
  double turns_per_m = 0;

  static constexpr std::size_t kMaxSignals = 8;
};

/// `signals`: snapshots x at most kMaxSignals.
BeamInput beam_input(const Eigen::Matrix3Xd& positions_m, double wavenumber_radpm,
                     const Eigen::MatrixXcd& signals);

/// z of every signal for one source.
struct BeamSum {
  std::array<std::complex<float>, BeamInput::kMaxSignals> z;
};

/// Unit direction of a source, and its curvature in 1/m.
struct BeamDirection {
  float x, y, z, curvature;
};

using BeamKernel = void (*)(const BeamInput& input, const BeamDirection* directions, std::size_t count,
                            BeamSum* sums);

/// Sums of the plane waves from u and from -u. Their steering vectors are conjugate, so both take the same
/// sines and products, at half the cost.
struct OppositeBeamSums {
  BeamSum ahead, behind;
};

/// Ignores the directions' curvatures.
using OppositeBeamKernel = void (*)(const BeamInput& input, const BeamDirection* directions,
                                    std::size_t count, OppositeBeamSums* sums);

/// Fastest kernels that this machine supports.
BeamKernel beam_kernel();
OppositeBeamKernel opposite_beam_kernel();

BeamKernel beam_kernel_sse2();
BeamKernel beam_kernel_avx2();  ///< x86-64 with AVX2 only
OppositeBeamKernel opposite_beam_kernel_sse2();
OppositeBeamKernel opposite_beam_kernel_avx2();  ///< x86-64 with AVX2 only

}  // namespace radioslam

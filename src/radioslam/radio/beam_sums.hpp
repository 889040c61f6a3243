// The inner loop of every profile: a wave from each of many sources is sought in several signals at once,
//   z_r = sum_k y_kr exp(j kappa e(p_k)).
// Single precision; eight sums side by side whatever the registers, single multiplications and additions,
// never fused: every machine gives the same bytes. There is one kernel per instruction set.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "radioslam/radio/synthetic_array.hpp"

namespace radioslam {

/// Signals over the snapshots of an array, laid out for the kernel; padded by silent snapshots.
struct BeamInput {
  std::size_t padded = 0;                        ///< snapshots, a multiple of eight
  std::size_t signals = 0;                       ///< at most kMostSignals
  std::vector<float> x_turns, y_turns, z_turns;  ///< kappa p/(2 pi)
  std::vector<float> square_turns;               ///< kappa |p|^2/(2 pi), per metre
  std::vector<float> real, imaginary;            ///< signals x padded
  double turns_per_m = 0;

  static constexpr std::size_t kMostSignals = 8;
};

/// `signals`: snapshots x at most kMostSignals.
BeamInput beam_input(const Eigen::Matrix3Xd& positions_m, double wavenumber_radpm,
                     const Eigen::MatrixXcd& signals);

/// z of one source, of every signal.
struct BeamSum {
  std::array<std::complex<float>, BeamInput::kMostSignals> z;
};

/// One source's direction, and its curvature in 1/m.
struct BeamDirection {
  float x, y, z, curvature;
};

using BeamKernel = void (*)(const BeamInput& input, const BeamDirection* directions, std::size_t count,
                            BeamSum* sums);

/// Of a plane wave from u and of one from -u, whose steering is the conjugate: both from the same sines and
/// products, in half the time.
struct OppositeBeamSums {
  BeamSum ahead, behind;
};

/// Curvatures are not looked at.
using OppositeBeamKernel = void (*)(const BeamInput& input, const BeamDirection* directions,
                                    std::size_t count, OppositeBeamSums* sums);

/// The fastest kernel that this machine can run.
BeamKernel beam_kernel();
OppositeBeamKernel opposite_beam_kernel();

BeamKernel beam_kernel_narrow();
BeamKernel beam_kernel_wide();  ///< x86-64 with AVX2 only
OppositeBeamKernel opposite_beam_kernel_narrow();
OppositeBeamKernel opposite_beam_kernel_wide();  ///< likewise

}  // namespace radioslam

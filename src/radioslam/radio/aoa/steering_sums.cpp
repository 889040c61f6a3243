#include "radioslam/radio/aoa/steering_sums.hpp"

#include <numbers>

#include "radioslam/base/check.hpp"

namespace radioslam {

BeamInput beam_input(const Eigen::Matrix3Xd& positions_m, double wavenumber_radpm,
                     const Eigen::MatrixXcd& signals) {
  RADIOSLAM_CHECK(positions_m.cols() == signals.rows(), "a position per snapshot");
  RADIOSLAM_CHECK(signals.cols() >= 1 && signals.cols() <= Eigen::Index{BeamInput::kMaxSignals},
                  "one to eight signals");
  BeamInput input;
  input.turns_per_m = wavenumber_radpm / (2 * std::numbers::pi);
  input.padded = (static_cast<std::size_t>(signals.rows()) + 7) / 8 * 8;
  input.signals = static_cast<std::size_t>(signals.cols());
  for (auto* turns : {&input.x_turns, &input.y_turns, &input.z_turns, &input.square_turns})
    turns->assign(input.padded, 0);
  input.real.assign(input.padded * input.signals, 0);
  input.imaginary = input.real;
  for (Eigen::Index k = 0; k < signals.rows(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Eigen::Vector3d turns = input.turns_per_m * positions_m.col(k);
    input.x_turns[at] = static_cast<float>(turns.x());
    input.y_turns[at] = static_cast<float>(turns.y());
    input.z_turns[at] = static_cast<float>(turns.z());
    input.square_turns[at] = static_cast<float>(input.turns_per_m * positions_m.col(k).squaredNorm());
    for (Eigen::Index r = 0; r < signals.cols(); ++r) {
      input.real[static_cast<std::size_t>(r) * input.padded + at] = static_cast<float>(signals(k, r).real());
      input.imaginary[static_cast<std::size_t>(r) * input.padded + at] =
          static_cast<float>(signals(k, r).imag());
    }
  }
  return input;
}

BeamKernel beam_kernel() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return beam_kernel_avx2();
#endif
  return beam_kernel_sse2();
}

OppositeBeamKernel opposite_beam_kernel() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return opposite_beam_kernel_avx2();
#endif
  return opposite_beam_kernel_sse2();
}

}  // namespace radioslam

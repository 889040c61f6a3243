// The few waves that make up a channel: orthogonal matching pursuit. The wave that explains most of what is
// left is added, and the amplitudes of all are solved again:
//   h(k, s) ~ sum_i c_i exp(-j (kappa e_i(p_k) + 2 pi f_s tau_i)).
// Source: Pati et al., Orthogonal Matching Pursuit, 1993; the atoms are the waves of synthetic_array.hpp.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "radioslam/radio/array_beams.hpp"
#include "radioslam/radio/beam_objective.hpp"

namespace radioslam {

struct WavePath {
  WaveSource source;
  double delay_s = 0;
  std::complex<double> amplitude = 0;
};

/// The paths, as found: the strongest first.
std::vector<WavePath> find_paths(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays,
                                 int count);

/// The same paths, each in turn moved to where it explains most of what the others leave, `rounds` times, and
/// all amplitudes solved again. `delays`: where each path's delay is sought.
std::vector<WavePath> refine_paths(std::vector<WavePath> paths, const SyntheticArray& array,
                                   const DelayTable& delays, const SourceBounds& bounds, int rounds);

/// What the paths make the channel at positions (3 x snapshots): snapshots x subcarriers.
Eigen::MatrixXcd channel_of(const std::vector<WavePath>& paths, const SyntheticArray& array);

}  // namespace radioslam

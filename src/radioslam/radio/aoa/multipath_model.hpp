// Multipath model of a channel as a sum of few waves, by orthogonal matching pursuit: repeatedly adds the
// wave that explains most of the residual, and solves all amplitudes again:
//   h(k, s) ~ sum_i c_i exp(-j (kappa e_i(p_k) + 2 pi f_s tau_i)).
// Source: Pati et al., Orthogonal Matching Pursuit, 1993; the atoms are the waves of synthetic_array.hpp.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "radioslam/radio/aoa/beam_objective.hpp"
#include "radioslam/radio/aoa/beamforming.hpp"

namespace radioslam {

struct WavePath {
  WaveSource source;
  double delay_s = 0;
  std::complex<double> amplitude = 0;
};

/// Paths in the order found, strongest first.
std::vector<WavePath> find_paths(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays,
                                 int count);

/// Refines every path in turn against the residual of the others, `rounds` times, and solves all amplitudes
/// again. `delays` are those searched for each path.
std::vector<WavePath> refine_paths(std::vector<WavePath> paths, const SyntheticArray& array,
                                   const DelayTable& delays, const SourceBounds& bounds, int rounds);

/// Channel (snapshots x subcarriers) that the paths predict at the array's positions.
Eigen::MatrixXcd channel_of(const std::vector<WavePath>& paths, const SyntheticArray& array);

}  // namespace radioslam

// Bartlett beamforming over a grid of sources, each at its best delay:
//   P(u) = max_tau |sum_ks h(k, s) exp(j (kappa e(p_k) + 2 pi f_s tau))|^2 / (K S sum |h|^2),
// between 0 and 1, the fraction of the channel's power that this one wave explains. Only the strongest
// singular vectors of the channel over the subcarriers are used: at most eight, each with at least a
// thousandth of the strongest one's power; omitting a fraction r of the power changes sqrt(P) by at most
// sqrt(r). Single precision (steering_sums.hpp).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/radio/aoa/aoa_array.hpp"
#include "radioslam/radio/aoa/synthetic_array.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {

struct ArrayBeams {
  std::vector<float> power;               ///< P of every source of the grid
  std::vector<std::uint16_t> best_delay;  ///< column of the delay table
};

/// Bartlett power over `grid`; `delays` must be made for the array's subcarriers.
ArrayBeams array_beams(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays);

}  // namespace radioslam

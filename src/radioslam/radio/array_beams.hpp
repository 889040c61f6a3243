// How strongly a wave from each source of a grid, at its best delay, is in a channel:
//   P(u) = max_tau |sum_ks h(k, s) exp(j (kappa e(p_k) + 2 pi f_s tau))|^2 / (K S sum |h|^2),
// between 0 and 1, the share of the channel that this one wave explains (Bartlett). Of the channel's
// singular vectors over the subcarriers the strongest carry the profile: those under a thousandth of the
// strongest's power are left out, and all after the eighth; a share r of the power left out changes the root
// of P by at most the root of r. In single precision (beam_sums.hpp).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/radio/subcarrier_slopes.hpp"
#include "radioslam/radio/synthetic_array.hpp"
#include "radioslam/radio/wave_grid.hpp"

namespace radioslam {

struct ArrayBeams {
  std::vector<float> power;               ///< of every source of the grid
  std::vector<std::uint16_t> best_delay;  ///< column of the delay table
};

/// `delays` for the array's subcarriers.
ArrayBeams array_beams(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays);

}  // namespace radioslam

// Refinement of AoA peaks: the Bartlett objective at continuous directions, its maximisation, and the
// covariance of the peak.
//
//   J(u) = 1/Q sum_q |Z_q(u)|^2 / E_q,  Z_q = sum_k w_k exp(j kappa e(p_k; u)),
// over the array's Q subarrays, w the channel at the subarray's best delay, E_q = K_q sum |h|^2 S. With theta
// = (azimuth, elevation, curvature), restricted to what is not at a bound of the search, the peak's
// covariance is the sandwich estimate (Huber 1967)
//   H^-1 (sum_b g_b g_b^T) H^-1,  H = -J'',  g_b the part of J' that block b of the path contributes.
// It covers whatever else is in the channel: other paths, noise, errors of the trajectory. Blocks rather than
// packets, as residuals of neighbouring packets are correlated. A common phase of a subarray does not change
// |Z_q| and is removed from the g_b. As subarrays overlap by half, every packet counts twice, which doubles
// the scatter.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/radio/aoa/synthetic_array.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {

/// Search bounds of a source. Where lower and upper bound are equal, the value is held.
struct SourceBounds {
  double max_curvature_per_m = 0;  ///< lower bound 0
  double min_elevation_rad = 0, max_elevation_rad = 0;
};

struct SourceSigma {
  double azimuth_rad = 0, elevation_rad = 0;
};

class BeamObjective {
 public:
  /// Each subarray's delay is the best one for a wave from `near`.
  BeamObjective(const std::vector<SyntheticArray>& subarrays, const DelayTable& delays,
                const WaveSource& near);

  double value(const WaveSource& source) const;

  /// Contribution of each block to the value; they sum to the value.
  std::vector<double> shares(const WaveSource& source) const;

  /// The nearest maximum within the bounds; azimuth is unbounded. Starting level on a level path, where the
  /// slope over elevation is zero, it stays level: an elevation would fit noise and degrade the azimuth.
  WaveSource climb(WaveSource from, const SourceBounds& bounds) const;

  /// Standard deviations at a peak; pi / sqrt(3), that of a uniform angle, where the objective is not concave
  /// and for an elevation that is held or at a bound.
  SourceSigma sigma(const WaveSource& peak, const SourceBounds& bounds) const;

 private:
  struct Subarray {
    Eigen::Matrix3Xd positions_m;
    Eigen::VectorXcd weights;  ///< per snapshot, scaled by 1 / sqrt(E_q)
    double wavenumber_radpm;
  };
  struct Slope;
  Slope slope(const WaveSource& source) const;

  std::vector<Subarray> subarrays_;
};

}  // namespace radioslam

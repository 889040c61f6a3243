// The profile at any source, not only on the grid, with what it takes to climb to its peak and to say how
// sure that peak is.
//
//   J(u) = 1/Q sum_q |Z_q(u)|^2 / E_q,  Z_q = sum_k w_k exp(j kappa e(p_k; u)),
// over the array's Q pieces, w the channel at the piece's best delay, E_q = K_q sum |h|^2 S. With theta =
// (azimuth, elevation, curvature), the peak's covariance is the sandwich
//   H^-1 (sum_b g_b g_b^T) H^-1,  H = -J'',  g_b the share of J' of the way's b-th block:
// over what is not at a bound of the search:
// what is left beside the wave (other paths, noise, errors of the trajectory) moves the peak as it moves the
// blocks' shares, whatever it is. Source: Huber 1967, with blocks since neighbours' rests are alike. What
// turns Z_q as a whole leaves |Z_q| as it is and is taken off the shares. Where
// pieces overlap by half, every packet's share stands in two of them, which doubles the scatter.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/radio/subcarrier_slopes.hpp"
#include "radioslam/radio/synthetic_array.hpp"

namespace radioslam {

/// Where a source is sought. A single value is held.
struct SourceBounds {
  double most_curvature_per_m = 0;  ///< from 0
  double least_elevation_rad = 0, most_elevation_rad = 0;
};

struct SourceSigma {
  double azimuth_rad = 0, elevation_rad = 0;
};

class BeamObjective {
 public:
  /// Delays are the best at `near`.
  BeamObjective(const std::vector<SyntheticArray>& pieces, const DelayTable& delays, const WaveSource& near);

  double value(const WaveSource& source) const;

  /// Each block's share of the value; their sum is the value.
  std::vector<double> shares(const WaveSource& source) const;

  /// The nearest peak within the bounds; azimuth has none. From the level of a level way, whose slope over
  /// elevation is none, it stays there: a raised direction explains noise too, and costs azimuth.
  WaveSource climb(WaveSource from, const SourceBounds& bounds) const;

  /// At a peak; the widest, half a turn over the square root of three, where the value does not bend down and
  /// for an elevation that is held or at a bound.
  SourceSigma sigma(const WaveSource& peak, const SourceBounds& bounds) const;

 private:
  struct Piece {
    Eigen::Matrix3Xd positions_m;
    Eigen::VectorXcd weights;  ///< over the snapshots, by 1 / sqrt(E_q)
    double wavenumber_radpm;
  };
  struct Slope;
  Slope slope(const WaveSource& source) const;

  std::vector<Piece> pieces_;
};

}  // namespace radioslam

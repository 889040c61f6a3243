// Synthetic array model: the channels that a moving antenna measured of one transmitter, and its positions.
//
// A wave from a source in direction u at distance 1/rho reaches position p, taken from the array's centre, by
//   e(p) = |p - u/rho| - 1/rho = (rho |p|^2 - 2 p.u) / (|rho p - u| + 1)
// metres after the centre; -p.u for a plane wave (rho = 0). The channel of a path is then
//   h(k, s) ~ exp(-j (kappa e(p_k) + 2 pi f_s tau)),
// with kappa = m 2 pi/lambda: m = 1 for a one-way channel or the difference of an antenna pair (whose
// positions are then the baseline), m = 2 for the two-way product. tau is the path's delay plus the card's
// own. Source: synthetic aperture as in WSR (Jadhav et al., section 4), with spherical waves. Frame: the
// trajectory's. Units: m, rad, Hz.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/geometry/direction.hpp"

namespace radioslam {

/// Where a wave comes from, seen from the array's centre.
struct WaveSource {
  double azimuth_rad = 0;
  double elevation_rad = 0;
  double curvature_per_m = 0;  ///< inverse distance; 0 for a plane wave

  Eigen::Vector3d direction() const { return unit_direction(azimuth_rad, elevation_rad); }
};

/// Path length to `position` minus that to the centre, metres, for a source in direction u.
inline double excess_path_m(const Eigen::Vector3d& u, double curvature_per_m,
                            const Eigen::Vector3d& position) {
  const double rho = curvature_per_m, along = position.dot(u);
  if (rho == 0) return -along;
  return (rho * position.squaredNorm() - 2 * along) / ((rho * position - u).norm() + 1);
}

inline double excess_path_m(const WaveSource& source, const Eigen::Vector3d& position) {
  return excess_path_m(source.direction(), source.curvature_per_m, position);
}

struct SyntheticArray {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd positions_m;       ///< relative to the centre, one column per snapshot
  Eigen::MatrixXcd channel;           ///< snapshots x subcarriers
  std::vector<double> subcarrier_hz;  ///< relative to the carrier
  double wavenumber_radpm = 0;        ///< kappa at the carrier frequency

  Eigen::Index snapshots() const { return channel.rows(); }
};

}  // namespace radioslam

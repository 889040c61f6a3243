// A radio that moves is an array: what it heard of one transmitter, and where it was each time.
//
// A wave from a source in direction u at distance 1/rho reaches position p, taken from the array's centre, by
//   e(p) = |p - u/rho| - 1/rho = (rho |p|^2 - 2 p.u) / (|rho p - u| + 1)
// metres more than the centre; -p.u where rho = 0, a plane wave. The channel of a path is then
//   h(k, s) ~ exp(-j (kappa e(p_k) + 2 pi f_s tau)),
// with kappa = m 2 pi/lambda: m = 1 for one way or the difference of two antennas, whose positions are then
// that difference, and m = 2 for both ways. tau is the path's delay, and what the card adds to it.
// Source: synthetic aperture as in WSR (Jadhav et al., section 4); spherical waves are textbook.
// Frame: the trajectory's. Units: m, rad, Hz.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/geometry/direction.hpp"

namespace radioslam {

/// Where a wave comes from, seen from the array's centre.
struct WaveSource {
  double azimuth_rad = 0;
  double elevation_rad = 0;
  double curvature_per_m = 0;  ///< one over the distance; 0: a plane wave

  Eigen::Vector3d direction() const { return unit_direction(azimuth_rad, elevation_rad); }
};

/// The way to `position` less the way to the centre, metres, from direction u.
inline double excess_way_m(const Eigen::Vector3d& u, double curvature_per_m,
                           const Eigen::Vector3d& position) {
  const double rho = curvature_per_m, along = position.dot(u);
  if (rho == 0) return -along;
  return (rho * position.squaredNorm() - 2 * along) / ((rho * position - u).norm() + 1);
}

inline double excess_way_m(const WaveSource& source, const Eigen::Vector3d& position) {
  return excess_way_m(source.direction(), source.curvature_per_m, position);
}

struct SyntheticArray {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd positions_m;       ///< from the centre, one column per snapshot
  Eigen::MatrixXcd channel;           ///< snapshots x subcarriers
  std::vector<double> subcarrier_hz;  ///< from the carrier
  double wavenumber_radpm = 0;        ///< kappa, of the carrier

  Eigen::Index snapshots() const { return channel.rows(); }
};

}  // namespace radioslam

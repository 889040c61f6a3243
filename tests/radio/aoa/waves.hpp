// Arrays and the channels of known waves, computed directly from |p - u/rho| - 1/rho in double precision.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam::waves {

inline constexpr double kDegree_rad = std::numbers::pi / 180;
inline constexpr double kWavenumber_radpm = 2 * std::numbers::pi * 5.54e9 / 299792458;

struct Wave {
  WaveSource source;
  double delay_s = 0;
  std::complex<double> amplitude = 1;
};

inline Eigen::Vector3d towards(const WaveSource& source) {
  return {std::cos(source.elevation_rad) * std::cos(source.azimuth_rad),
          std::cos(source.elevation_rad) * std::sin(source.azimuth_rad), std::sin(source.elevation_rad)};
}

/// Distance from the source to p minus that to the centre.
inline double further_m(const WaveSource& source, const Eigen::Vector3d& p) {
  if (source.curvature_per_m == 0) return -p.dot(towards(source));
  const double distance_m = 1 / source.curvature_per_m;
  return (p - distance_m * towards(source)).norm() - distance_m;
}

inline std::vector<double> subcarriers(int count = 30) {
  std::vector<double> hz;
  for (int s = 0; s < count; ++s) hz.push_back(-8.75e6 + 17.5e6 * s / (count - 1));
  return hz;
}

/// An arc in the plane, relative to its mean.
inline Eigen::Matrix3Xd arc(int snapshots, double radius_m, double turn_rad) {
  Eigen::Matrix3Xd positions(3, snapshots);
  for (int k = 0; k < snapshots; ++k) {
    const double angle = turn_rad * k / std::max(snapshots - 1, 1);
    positions.col(k) = radius_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  }
  positions.colwise() -= positions.rowwise().mean().eval();
  return positions;
}

inline std::complex<double> channel_at(const Wave& wave, const Eigen::Vector3d& p, double wavenumber_radpm,
                                       double hz) {
  return wave.amplitude * std::polar(1.0, -wavenumber_radpm * further_m(wave.source, p) -
                                              2 * std::numbers::pi * hz * wave.delay_s);
}

/// Array at these positions with the channel that the waves produce.
inline SyntheticArray array_of(const std::vector<Wave>& all, const Eigen::Matrix3Xd& positions_m,
                               double wavenumber_radpm = kWavenumber_radpm) {
  SyntheticArray array;
  array.positions_m = positions_m;
  array.subcarrier_hz = subcarriers();
  array.wavenumber_radpm = wavenumber_radpm;
  array.channel.setZero(positions_m.cols(), std::ssize(array.subcarrier_hz));
  for (const Wave& wave : all)
    for (Eigen::Index k = 0; k < array.channel.rows(); ++k)
      for (Eigen::Index s = 0; s < array.channel.cols(); ++s)
        array.channel(k, s) += channel_at(wave, positions_m.col(k), wavenumber_radpm,
                                          array.subcarrier_hz[static_cast<std::size_t>(s)]);
  return array;
}

inline Eigen::MatrixXcd noise(Eigen::Index rows, Eigen::Index columns, double sigma, Rng& rng) {
  Eigen::MatrixXcd values(rows, columns);
  for (Eigen::Index k = 0; k < rows; ++k)
    for (Eigen::Index s = 0; s < columns; ++s)
      values(k, s) = {rng.normal(0, sigma / std::numbers::sqrt2), rng.normal(0, sigma / std::numbers::sqrt2)};
  return values;
}

inline double apart_rad(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

}  // namespace radioslam::waves

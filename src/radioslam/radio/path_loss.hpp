// How a signal weakens on its way.
//   free space   FSPL(dB) = 20 log10(d / km) + 20 log10(f / MHz) + 32.44              (Friis 1946)
//   buildings    P(d) = P0 - 10 n log10(d / d0) + N(0, sigma^2),  d0 = 1 m            (log-distance)
#pragma once

namespace radioslam {

/// Loss over a distance in free space, decibels; distance and frequency above 0.
double free_space_loss_db(double distance_m, double frequency_mhz);
/// The distance over which free space loses so much: the radius of a sphere around a receiver on which a
/// transmitter would stand if nothing were in between. Walls make it an upper bound.
double free_space_distance_m(double loss_db, double frequency_mhz);

/// The log-distance law of one transmitter.
struct PathLoss {
  double power_at_1m_dbm = -40;  ///< P0
  double exponent = 3;           ///< n

  double power_dbm(double distance_m) const;
  /// The distance at which this power is expected.
  double distance_m(double power_dbm) const;
};

}  // namespace radioslam

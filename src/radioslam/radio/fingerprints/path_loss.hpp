// Path loss models: free space, and the log-distance law for buildings.
//   free space   FSPL(dB) = 20 log10(d / km) + 20 log10(f / MHz) + 32.44              (Friis 1946)
//   buildings    P(d) = P0 - 10 n log10(d / d0) + N(0, sigma^2),  d0 = 1 m            (log-distance)
#pragma once

namespace radioslam {

/// Free-space path loss in dB; distance and frequency must be positive.
double free_space_loss_db(double distance_m, double frequency_mhz);
/// Distance at which free space has this path loss. With walls in between it is an upper bound.
double free_space_distance_m(double loss_db, double frequency_mhz);

/// Log-distance path loss of one transmitter.
struct PathLoss {
  double power_at_1m_dbm = -40;  ///< P0
  double exponent = 3;           ///< n

  double power_dbm(double distance_m) const;
  /// Distance at which this power is expected.
  double distance_m(double power_dbm) const;
};

}  // namespace radioslam

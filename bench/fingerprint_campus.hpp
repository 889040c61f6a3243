// Simulated fingerprints of walkers on a campus, for benchmarks: access points of limited range, log-distance
// path loss, shadowing constant within a few metres, noise, missed detections of weak access points.
// Deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprints/fingerprint.hpp"

namespace radioslam {

struct Campus {
  double side_m = 1000;
  std::size_t access_points = 4000;
  std::size_t walkers = 200;
  std::size_t fingerprints = 100000;  ///< total over all walkers
  std::size_t heard = 50;             ///< access points per fingerprint, the strongest ones
  double step_m = 6;                  ///< path length between fingerprints
  int scans = 3;                      ///< per fingerprint
  std::uint64_t seed = 1;
};

/// Fingerprints ordered by walker, then by time.
std::vector<Fingerprint> campus_fingerprints(const Campus& campus);

}  // namespace radioslam

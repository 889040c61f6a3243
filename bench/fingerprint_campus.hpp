// Fingerprints as walkers on a campus would take them, for benchmarks: access points of limited reach,
// log-distance path loss, shadowing that stays the same within a few metres, noise, weak ones missed in some
// scans. Deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/radio/fingerprint.hpp"

namespace radioslam {

struct Campus {
  double side_m = 1000;
  std::size_t access_points = 4000;
  std::size_t walkers = 200;
  std::size_t fingerprints = 100000;  ///< of all walkers together
  std::size_t heard = 50;             ///< access points of a fingerprint, the strongest
  double step_m = 6;                  ///< way between fingerprints
  int scans = 3;                      ///< of a fingerprint
  std::uint64_t seed = 1;
};

/// Walker by walker, each in time order.
std::vector<Fingerprint> campus_fingerprints(const Campus& campus);

}  // namespace radioslam

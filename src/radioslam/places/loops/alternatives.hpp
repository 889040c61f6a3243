// What other explanations of a scan weigh (see loop_verification.hpp).
#pragma once

#include <cmath>

namespace radioslam {

inline constexpr double kFits = 0.3;         ///< likelihood from which a pose counts as one that fits
inline constexpr double kUnseenFits = 0.02;  ///< before any was found
inline constexpr double kUnseenShare = 0.2;  ///< of the area that is possible
inline constexpr double kLeastWeight = 1e-12;

/// Of a pose relative to the best, by how well each explains the scan; e^-3, twenty times less likely, at
/// the ratio `alternative_ratio`.
inline double likelihood_beside(double best, double fit, double alternative_ratio) {
  constexpr double kAlternativeLog = 3;
  const double worse = best > 0 ? (1 - fit / best) / (1 - alternative_ratio) : 0;
  return std::exp(-kAlternativeLog * worse * worse);
}

/// Weight of places that were not seen, of which as many may fit per area as did where it was.
inline double weight_of_unseen(double fitting, double seen_m2, double possible_m2) {
  return kUnseenShare * fitting / seen_m2 * possible_m2;
}

}  // namespace radioslam

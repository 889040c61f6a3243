// Exponential decay of similarity with distance, d = -L ln s, with one decay length for the whole mission.
// Sørensen similarity follows this law from a few metres to several times L, far beyond the distances for
// which a short path can train DistanceModel, so it can place robots whose starts are unknown.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/radio/fingerprints/distance_model.hpp"

namespace radioslam {

/// d = -length_m ln s.
struct DecayModel {
  double length_m = 0;

  /// Distance at similarity `s` in (0, 1]; at least `kNearest_m`, below which similarity is uninformative.
  double distance_m(double s) const;

  static constexpr double kNearest_m = 1;
};

/// Decay length as the median of d / -ln s over samples of informative similarity (0.02 to 0.9) whose
/// positions are at least 2 m apart; nothing with fewer than `min_samples` of them.
std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int min_samples);

}  // namespace radioslam

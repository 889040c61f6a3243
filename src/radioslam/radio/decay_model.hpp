// Similarity that decays exponentially with distance: d = -L ln s, one length for the whole mission.
// Sørensen similarity follows this law from a few metres to several times L, far beyond the distances that
// a short walk can train bin by bin, so it can lay out a team whose starts are unknown.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/radio/distance_model.hpp"

namespace radioslam {

/// d = -length_m ln s.
struct DecayModel {
  double length_m = 0;

  /// Distance at similarity `s` in (0, 1]; at least `kNearest_m`, below which similarity says no more.
  double distance_m(double s) const;

  static constexpr double kNearest_m = 1;
};

/// The length as the median of d / -ln s over samples whose similarity tells anything (0.02 to 0.9) and
/// whose ends are at least 2 m apart; nothing with fewer than `minimum_samples` of them.
std::optional<DecayModel> fit_decay(const std::vector<DistanceSample>& samples, int minimum_samples);

}  // namespace radioslam

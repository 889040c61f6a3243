// Threshold sweep: what tuning threshold and loss by hand would gain. Simulated car parks or recorded
// missions, estimated with the defaults and over a grid of nu (the same within a robot and between robots)
// and of the closures' loss, everything else at its default. The best cell is chosen by the truth, the
// defaults are not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/study/fingerprints/study_missions.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

struct ThresholdGrid {
  std::vector<double> nu_m{3, 4, 5, 7, 10, 15, 20, 30, 40};
  /// Final scales of the Cauchy loss, in standard deviations, reached as by default; nothing: least squares.
  std::vector<std::optional<double>> loss_sigmas{{}, 4, 2, 1, 0.5};
};

struct ThresholdCell {
  double nu_m = 0;
  std::optional<double> loss_sigmas;
  std::optional<double> ate_m = {};
};

/// One mission with one measure. Dead reckoning needs known starts. Errors: position, RMSE after one
/// alignment of the team.
struct SweptMission {
  std::string name;
  std::optional<double> dead_reckoning_ate_m, default_ate_m;
  std::vector<ThresholdCell> cells;
  std::optional<std::uint64_t> seed = {};  ///< of a simulated one
  std::string measure = {};                ///< empty: the default

  /// The cell of the smallest error, or null.
  const ThresholdCell* best() const;
  /// The default's error relative to that of the best cell, and to that of dead reckoning.
  std::optional<double> default_over_best() const, default_over_dead_reckoning() const;
};

/// Every mission with each of the measures (an empty name: the default). Independent of the number of
/// threads. Cost: a run per cell, tens of core-seconds per car park.
std::vector<SweptMission> sweep_thresholds(const std::vector<StudyMission>& missions,
                                           const ThresholdGrid& grid,
                                           const std::vector<std::string>& measures = {""},
                                           const Progress& progress = {});

/// A row per mission, then median and worst.
StudyTable threshold_sweep_table(const std::vector<SweptMission>& missions);

/// "ν 5 m, Cauchy 1 σ".
std::string label_of(const ThresholdCell& cell);

}  // namespace radioslam

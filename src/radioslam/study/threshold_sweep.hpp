// What a hand-tuned threshold and loss would have been worth: simulated car parks, each estimated with the
// defaults and over a grid of nu (the same within a robot and between robots) and of the closures' loss.
// Everything else is at its default. The best cell knows the truth, the defaults do not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/sim/carpark.hpp"
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

/// One mission. Errors: position, RMSE after one alignment of the team.
struct SweptMission {
  std::uint64_t seed = 0;
  std::optional<double> dead_reckoning_ate_m, default_ate_m;
  std::vector<ThresholdCell> cells;

  /// The cell of the least error; nullptr where there is none.
  const ThresholdCell* best() const;
  /// The default's error over the best cell's, and over that of dead reckoning.
  std::optional<double> default_over_best() const, default_over_dead_reckoning() const;
};

/// Seeds from `first_seed` on. The same for any number of threads. Cost: some tens of core-seconds a mission.
std::vector<SweptMission> sweep_thresholds(const CarparkParams& carpark, const ThresholdGrid& grid,
                                           std::uint64_t first_seed, int seeds,
                                           const Progress& progress = {});

/// A row per mission, then their median and worst.
StudyTable threshold_sweep_table(const std::vector<SweptMission>& missions);

/// "ν 5 m, Cauchy 1 σ".
std::string label_of(const ThresholdCell& cell);

}  // namespace radioslam

// Robustness map: the team's error relative to the oracle's, and the recall of the overlap search, over the
// noise of angles, the number of links and the number of false paths per angle measurement; named as future
// work in Wi-Closure (Wang et al.).
//
// Each cell consists of a few simulated towns (sim/scenarios/city.hpp) with the same seeds as in every other
// cell, so that cells differ by their axes only and not by their towns. A run has failed if its error exceeds
// both kFailedRatio times the oracle's and the oracle's plus kFailedExcess_m; it was confidently wrong if it
// failed, gave its hypothesis at least kConfidentWeight, and no alternative was right either. Cost: a
// simulation, a run and an oracle per cell and seed; 0.3 to 1 s each.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/sim/scenarios/study_scenarios.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

inline constexpr double kFailedRatio = 2;
inline constexpr double kFailedExcess_m = 1;
inline constexpr double kConfidentWeight = 0.9;

/// The axes of the map.
struct RobustnessGrid {
  std::vector<double> sigma_angle_deg{2, 5, 10, 20, 40};
  std::vector<int> links{3, 5, 10, 20, 40};
  std::vector<int> false_paths{0, 2, 5, 10};
};

/// One simulated town, evaluated.
struct RobustnessSample {
  std::optional<double> ate_m, best_ate_m, ate_oracle_m;
  std::optional<double> recall, rejected_false;
  double weight = 1;

  std::optional<double> ratio() const;  ///< error of the most likely hypothesis, relative to the oracle's
  bool failed() const;
  bool confidently_wrong() const;
};

struct RobustnessCell {
  double sigma_angle_deg = 0;
  int links = 0, false_paths = 0;
  std::vector<RobustnessSample> samples;  ///< by seed
};

struct RobustnessMap {
  RobustnessGrid grid;
  std::uint64_t first_seed = 1;
  int seeds = 0;
  std::vector<RobustnessCell> cells;  ///< by false paths, then links, then noise, which varies fastest
};

/// Independent of the number of threads. `progress` is called from one thread at a time.
RobustnessMap map_robustness(const RobustnessGrid& grid, const CityParams& town, std::uint64_t first_seed,
                             int seeds, const Progress& progress = {});

/// A row per cell: medians, worst cases and failure ratios.
StudyTable robustness_table(const RobustnessMap& map);

/// Summary statistics of a cell of the robustness map.
struct RobustnessSummary {
  std::optional<double> ratio, worst_ratio;   ///< error relative to the oracle's: median, largest
  std::optional<double> ate_m, ate_oracle_m;  ///< medians
  std::optional<double> recall, min_recall;
  std::optional<double> rejected_false;
  double failed = 0, confidently_wrong = 0;  ///< ratios of the seeds
};

RobustnessSummary summarise(const RobustnessCell& cell);

}  // namespace radioslam

// Summary statistics of a cell of the robustness map.
#pragma once

#include <optional>

#include "radioslam/study/robustness_map/robustness_map.hpp"

namespace radioslam {

struct RobustnessSummary {
  std::optional<double> ratio, worst_ratio;   ///< error relative to the oracle's: median, largest
  std::optional<double> ate_m, ate_oracle_m;  ///< medians
  std::optional<double> recall, min_recall;
  std::optional<double> rejected_false;
  double failed = 0, confidently_wrong = 0;  ///< ratios of the seeds
};

RobustnessSummary summarise(const RobustnessCell& cell);

}  // namespace radioslam

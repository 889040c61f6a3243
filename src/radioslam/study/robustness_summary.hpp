// A cell of the robustness map in a few numbers.
#pragma once

#include <optional>

#include "radioslam/study/robustness_map.hpp"

namespace radioslam {

struct RobustnessSummary {
  std::optional<double> ratio, worst_ratio;   ///< of the errors, run to oracle: median, largest
  std::optional<double> ate_m, ate_oracle_m;  ///< medians
  std::optional<double> recall, least_recall;
  std::optional<double> false_rejected;
  double failed = 0, confidently_wrong = 0;  ///< shares of the seeds
};

RobustnessSummary summarise(const RobustnessCell& cell);

}  // namespace radioslam

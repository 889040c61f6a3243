// Converts evaluation metrics to JSON, with the keys of `evaluate --json`. Unavailable values are null.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/eval/closures.hpp"
#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_p90_m", "rpe": {...}, "coverage", "robots": {id: {...}}}
nlohmann::ordered_json metrics_json(const TeamMetrics& metrics);

/// {"pairs", "true", "kept", "true_kept"}
nlohmann::ordered_json pair_counts_json(const PairCounts& counts);

}  // namespace radioslam

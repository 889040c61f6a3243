// Converts evaluation metrics to JSON, with the keys of `evaluate --json`. Unavailable values are null.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/eval/access_point_errors.hpp"
#include "radioslam/eval/closures.hpp"
#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_p90_m", "rpe": {...}, "coverage", "robots": {id: {...}}}
nlohmann::ordered_json metrics_json(const TeamMetrics& metrics);

/// {"pairs", "true", "kept", "true_kept"}
nlohmann::ordered_json pair_counts_json(const PairCounts& counts);

/// By kind {"accepted", "true_accepted", "rejected", "true_rejected"}, of angles also {"direct_found",
/// "wrong_path", "none_direct"}.
nlohmann::ordered_json closures_by_kind_json(const ClosuresByKind& closures);

/// {"known", "located", "rmse_m", "mean_m", "median_m", "p90_m"}; null without known access points.
nlohmann::ordered_json access_point_errors_json(const AccessPointErrors& errors);

}  // namespace radioslam

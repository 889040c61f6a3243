// Page data of closures: counts of all, and as many lines as the budget allows.
#pragma once

#include <vector>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Per robot, the drawn keyframes as indices into its estimate.
using DrawnKeyframes = std::vector<std::vector<std::size_t>>;

/// {"groups": [{"kind", "status", "count", "drawn"}], "reasons": [{"kind", "status", "reason", "count",
///   "statistic_median"}], "drawn": {"group", "robot_i", "keyframe_i", "robot_j", "keyframe_j",
///   "statistic"}}.
/// Keyframes in `drawn` are indices into the drawn keyframes.
PageData closure_data(const RunResult& result, const DrawnKeyframes& keyframes, const ReportParams& params);

/// [{"kind", "accepted", "true_accepted", "rejected", "true_rejected", "direct_found", "wrong_path",
///   "none_direct"}]; the last three of angles only.
PageData judged_closure_data(const ClosuresByKind& closures);

}  // namespace radioslam

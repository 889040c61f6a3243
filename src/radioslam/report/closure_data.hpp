// Page data of closures: counts of all, and as many lines as the budget allows.
#pragma once

#include <vector>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

// Page data of the pairs kept by the overlap search: a matrix per pair of robots, with bins of keyframes of
// robot i horizontally and of robot j vertically, each with its number of kept pairs. Binning keeps the page
// small for millions of pairs while counting every one.

/// {"kept", "pairs", "distances_evaluated", "robot_pairs", "matrices": [{"robot_i", "robot_j", "kept",
///   "bins_i", "bins_j", "cell": [...], "count": [...]}]}, robot_i listed before robot_j. Only the matrices
///   with the
///   most pairs, in decreasing order; "robot_pairs" counts the pairs of robots with any kept pair.
/// cell = bin_j * bins_i + bin_i, increasing; keyframe k of n is in bin floor(k bins / n). "pairs" and
/// "distances_evaluated" are null if the run did not search.
PageData candidate_data(const RunResult& result, const ReportParams& params);

/// As the page has them.
const char* name_of(ClosureKind kind);
const char* name_of(ClosureStatus status);

/// Per robot, the drawn keyframes as indices into its estimate.
using DrawnKeyframes = std::vector<std::vector<std::size_t>>;

/// {"groups": [{"kind", "status", "count", "drawn"}], "reasons": [{"kind", "status", "reason", "count",
///   "statistic_median"}], "drawn": {"group", "reason", "robot_i", "keyframe_i", "robot_j",
///   "keyframe_j", "statistic"}}.
/// Keyframes in `drawn` are indices into the drawn keyframes, reasons into `reasons`.
PageData closure_data(const RunResult& result, const DrawnKeyframes& keyframes, const ReportParams& params);

/// [{"kind", "accepted", "true_accepted", "rejected", "true_rejected", "direct_found", "wrong_path",
///   "none_direct"}]; the last three of angles only.
PageData compared_closure_data(const ClosuresByKind& closures);

/// {"pairs", "allowed", "compared", "registered", "verified", "accepted", "true", "false"}: how many pairs of
/// keyframes of different robots came how far by their scans. "true" and "false" are those accepted ones that
/// the truth covers, absent without it. Null if no scans of different robots were compared.
PageData place_data(const RunResult& result, const ClosuresByKind& compared_closures);

}  // namespace radioslam

// Closures on the page: every one counted, and as many drawn as the budget allows.
#pragma once

#include <vector>

#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// Per robot, the drawn keyframes as indices into its estimate.
using DrawnKeyframes = std::vector<std::vector<std::size_t>>;

/// {"groups": [{"kind", "status", "count", "drawn"}], "reasons": [{"kind", "status", "reason", "count",
///   "statistic_median"}], "drawn": {"group", "robot_i", "keyframe_i", "robot_j", "keyframe_j",
///   "statistic"}}.
/// `drawn` refers to places among the drawn keyframes.
PageData closure_data(const RunResult& result, const DrawnKeyframes& keyframes, const ReportParams& params);

}  // namespace radioslam

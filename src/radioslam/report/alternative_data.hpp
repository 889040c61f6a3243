// Page data of the other hypotheses of the team alignment, drawn as faint lines next to the most likely one.
#pragma once

#include "radioslam/report/page_json.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/trajectory_data.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// [{"weight", "ate_rmse_m" if the truth is known, "robots": [{"x", "y", "z" in space}]}], most likely first;
/// paths thinned to the budget, in the frame of the page, in which the most likely hypothesis is drawn.
PageData alternative_data(const RunResult& result, const TrajectoryContext& context,
                          const ReportParams& params);

}  // namespace radioslam

// The other ways the team may lie, as faint lines beside the likeliest one.
#pragma once

#include "radioslam/report/page_data.hpp"
#include "radioslam/report/trajectory_data.hpp"

namespace radioslam {

/// [{"weight", "ate_rmse_m" where the truth is known, "robots": [{"x", "y", "z" in space}]}], likeliest
/// first; paths thinned to the budget, in the frame of the page: that in which the likeliest team is drawn.
PageData alternative_data(const RunResult& result, const TrajectoryContext& context,
                          const ReportParams& params);

}  // namespace radioslam

// Page data: everything the report page shows as one JSON object, with a fixed key order and rounded numbers.
// Metres are rounded to 1 mm, times to 1 ms relative to `start_s`; positions are in the truth's frame if
// there are metrics, else in the estimate's. Columns rather than rows: {"x": [...], "y": [...]}. Unknown
// values are null or absent.
#pragma once

#include <optional>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/report/page_json.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

PageData page_data(const RunResult& result, const Truth* truth, const std::optional<TeamMetrics>& metrics,
                   const ClosuresByKind& judged_closures, const ReportParams& params);

}  // namespace radioslam

// What the page shows, as JSON: one object, keys in a fixed order, numbers rounded to what can be seen.
// Metres are rounded to 1 mm, times to 1 ms and counted from `start_s`; positions are in the truth's frame
// where metrics exist, else in the estimate's. Columns rather than rows: {"x": [...], "y": [...]}. What is
// not known is null or absent.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "radioslam/report/report.hpp"

namespace radioslam {

using PageData = nlohmann::ordered_json;

PageData page_data(const RunResult& result, const Truth* truth, const std::optional<TeamMetrics>& metrics,
                   const ReportParams& params);

}  // namespace radioslam

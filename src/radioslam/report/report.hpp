// Report of a run as one self-contained HTML page: data, style, script and d3 in one file that opens offline.
// The data are one JSON element; the same input gives the same bytes. Ids, names and
// reasons are foreign text and reach the page as data only, never as markup.
#pragma once

#include <optional>
#include <string>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/results/agents_result.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/results/stream_result.hpp"

namespace radioslam {

/// The page. `truth` may be null; with `truth` and `metrics` the map is drawn in the truth's frame (through
/// metrics->T_truth_estimate), and dead reckoning is evaluated as well, after its own alignment.
/// `compared_closures` are shown beside the closures; `stream`, of a streamed mission, and `agents`, of one
/// lived through by agents, may be null.
std::string render_report(const RunResult& result, const Truth* truth = nullptr,
                          const std::optional<TeamMetrics>& metrics = std::nullopt,
                          const ClosuresByKind& compared_closures = {}, const ReportParams& params = {},
                          const StreamResult* stream = nullptr, const AgentsResult* agents = nullptr);

}  // namespace radioslam

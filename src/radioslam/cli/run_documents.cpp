#include "radioslam/cli/run_documents.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>
#include <variant>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/run/metrics_json.hpp"
#include "radioslam/report/report.hpp"

namespace radioslam::cli {

MissionInput for_evaluation(MissionInput& input) {
  MissionInput given;
  given.mission = without_recordings(input.mission);
  given.truth = std::exchange(input.truth, {});
  given.loops = std::exchange(input.loops, {});
  given.pose_ids = std::move(input.pose_ids);
  given.point_ids = std::move(input.point_ids);
  return given;
}

Agreement evaluate(const RunResult& result, const MissionInput& given) {
  if (given.truth.empty()) return {};
  Agreement agreement{evaluate_trajectories(team_estimate(result), given.truth, result.dimension), {}};
  // An agent may not know all robots of its mission; then they have other numbers.
  if (names_of(result.robots) == names_of(given.mission.robots))
    agreement.closures = compare_closures_with_truth(result, given.mission, given.truth, given.loops);
  return agreement;
}

RunDocuments documents_of(const RunOutput& run, const MissionInput& given, const Agreement& agreement,
                          const StreamResult* stream, const AgentsResult* agents) {
  RunDocuments documents;
  if (agreement.metrics) {
    documents.metrics = metrics_json(*agreement.metrics);
    documents.metrics["closures"] = closures_by_kind_json(agreement.closures);
  }
  documents.graph_g2o = std::visit(
      [&](const auto& graph) { return format_g2o(with_ids(graph, given.pose_ids, given.point_ids)); },
      run.graph);
  documents.report_html = render_report(run.result, given.truth.empty() ? nullptr : &given.truth,
                                        agreement.metrics, agreement.closures, {}, stream, agents);
  return documents;
}

std::string error_text(const TeamMetrics& metrics) {
  if (!metrics.ate) return {};
  std::ostringstream text;
  text << ", position error " << metrics.ate->rmse_m << " m rmse";
  // Rounded down, so that an incomplete coverage never reads 100 %.
  if (metrics.coverage < 1)
    text << std::fixed << std::setprecision(1) << " over " << std::floor(1000 * metrics.coverage) / 10
         << " % of the true poses";
  return text.str();
}

}  // namespace radioslam::cli

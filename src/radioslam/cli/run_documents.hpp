// What a run is evaluated and written by, beside its result.
#pragma once

#include <optional>
#include <string>

#include "radioslam/cli/commands/evaluation.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/results/agents_result.hpp"
#include "radioslam/results/stream_result.hpp"

namespace radioslam::cli {

/// Agreement of a run with the truth; empty without one.
struct Agreement {
  std::optional<TeamMetrics> metrics;
  ClosuresByKind closures;
};

/// What of an input its run is evaluated and written by. Takes the truth from it: no estimator sees it.
MissionInput for_evaluation(MissionInput& input);

/// `given`: the input without its recordings and its graph.
Agreement evaluate(const RunResult& result, const MissionInput& given);
RunDocuments documents_of(const RunOutput& run, const MissionInput& given, const Agreement& agreement,
                          const StreamResult* stream = nullptr, const AgentsResult* agents = nullptr);

/// ", position error 2.1 m rmse", with the coverage of the true poses unless it is complete.
std::string error_text(const TeamMetrics& metrics);

}  // namespace radioslam::cli

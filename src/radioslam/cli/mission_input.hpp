// What run, prune and evaluate take: a mission's folder, or a team's factor graph (.g2o, .pyfg, with .zst).
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam::cli {

struct MissionInput {
  Mission mission;  ///< of a graph: its robots with dead reckoning, in the order of their poses
  Truth truth;      ///< of a graph: what its VERTEX lines say, where these are the truth
  std::variant<std::monostate, TeamGraph<SE2>, TeamGraph<SE3>> graph;
};

MissionInput read_input(const std::string& path);

/// run_pipeline with whichever it is.
RunOutput run_input(const MissionInput& input, const RunParams& params, const RunOptions& options,
                    const Progress& progress);

}  // namespace radioslam::cli

// Offline pipeline: estimates the joint trajectory of a team from its recorded mission.
#pragma once

#include <variant>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/pipeline/run_options.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Results of a run and its final graph.
struct RunOutput {
  RunResult result;
  std::variant<PoseGraph2, PoseGraph3> graph;
};

/// Estimates the joint trajectory of the team. Deterministic: the same mission and parameters give identical
/// numbers for any number of threads. RunResult::parameters is left for the caller to fill.
RunOutput run_pipeline(Mission mission, const RunParams& params, const RunOptions& options = {},
                       const Progress& progress = {});

/// The same for a team given as a factor graph; `mission` contains its robots and no other measurements.
template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options = {}, const Progress& progress = {});

}  // namespace radioslam

// The offline composition: recordings in, one map of the team out.
#pragma once

#include <variant>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/match_stage.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// How far a run goes.
struct RunOptions {
  Pruning pruning = Pruning::kOn;
  SearchMethod search = SearchMethod::kTree;
  bool overlap_only = false;  ///< stop after the overlap search
};

/// What a run leaves: its results and the final graph.
struct RunOutput {
  RunResult result;
  std::variant<PoseGraph2, PoseGraph3> graph;
};

/// Estimates the joint trajectory of the team. Deterministic: the same mission and parameters give the same
/// numbers for any number of threads. RunResult::parameters is left to the caller.
RunOutput run_pipeline(const Mission& mission, const RunParams& params, const RunOptions& options = {},
                       const Progress& progress = {});

/// The same for a team that comes as a factor graph; `mission` has its robots and nothing else that is
/// measured.
template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options = {}, const Progress& progress = {});

}  // namespace radioslam

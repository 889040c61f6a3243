#include "radioslam/pipeline/pipeline.hpp"

#include <utility>

#include "radioslam/pipeline/field_stage.hpp"
#include "radioslam/pipeline/honest_graph.hpp"
#include "radioslam/pipeline/joint_graph_of_team.hpp"
#include "radioslam/pipeline/recordings_stage.hpp"
#include "radioslam/pipeline/run_results.hpp"

namespace radioslam {
namespace {

/// That of a team that comes as one, or out of the mission, with nodes where loops and fixes tie.
template <class Pose>
JointGraph<Pose> make_joint_graph(const Mission& mission, const TeamGraph<Pose>* team,
                                  const std::vector<ScanClosure>& loops, const RunParams& params) {
  if (team) return joint_graph_of(*team, mission);
  std::vector<std::vector<Stamp>> moments(mission.robots.size());
  add_closure_moments(loops, moments);
  add_fix_moments(mission, moments);
  return build_joint_graph<Pose>(mission, params.keyframe, params.graph, std::move(moments));
}

template <class Pose>
TeamPlacement<Pose> place_team(JointGraph<Pose>& joint, const Mission& placed, const RadioMeasurements& radio,
                               const RunParams& params, const Progress& progress) {
  return has_radio_links(joint) ? place_by_radio(joint, params.alignment, progress)
                                : place_by_fingerprints(joint, placed, radio, params.team_frame, progress);
}

/// Whether somebody is there to look at the pairs that survive: links that could prune, or matches to prune.
bool wants_overlaps(const Mission& mission, const RunOptions& options) {
  return options.overlap_only || !mission.ranges.empty() || !mission.arrivals.empty() ||
         !mission.matches.empty();
}

template <class Pose>
void search_overlaps_into(RunResult& result, const JointGraph<Pose>& joint, const RunParams& params,
                          const RunOptions& options) {
  const OverlapStage stage = find_overlaps(joint, params.overlap, options.search);
  if (!stage.searched)
    result.notes.push_back("no pairs were searched: the estimate's covariances are singular");
  if (!stage.searched) return;
  result.counts["pairs"] = static_cast<double>(stage.counts.pairs);
  result.counts["candidates"] = static_cast<double>(stage.counts.kept);
  result.counts["distances_evaluated"] = static_cast<double>(stage.counts.distances_evaluated);
  result.candidates = stage.candidates;
}

/// Admits the matches and settles which of them hold.
template <class Pose>
std::vector<ClosureResult> close_by_matches(JointGraph<Pose>& joint, const Mission& mission,
                                            const std::vector<CandidateResult>& candidates,
                                            const RunParams& params, const RunOptions& options,
                                            const Progress& progress) {
  auto verdicts = admit_matches(joint, mission, candidates, options.pruning, params.matches, params.angles);
  settle_matches(joint, verdicts, params.matches, params.optimizer, progress);
  std::vector<ClosureResult> results;
  for (const MatchVerdict& verdict : verdicts)
    results.push_back({verdict.tie.robot_i, verdict.tie.stamp_i, verdict.tie.robot_j, verdict.tie.stamp_j,
                       ClosureKind::kMatch, verdict.status, verdict.statistic, verdict.reason});
  return results;
}

/// The pairs of keyframes that may have seen one place, and which of the mission's matches hold.
template <class Pose>
void compare_places(RunResult& result, TeamEstimate<Pose>& estimate, const Mission& mission,
                    const RunParams& params, const RunOptions& options, const Progress& progress,
                    StageClock& clock) {
  JointGraph<Pose>& joint = estimate.joint;
  if (wants_overlaps(mission, options))
    clock.time("overlap", [&] {
      search_overlaps_into(result, honest(joint, params.alignment.mixture), params, options);
    });
  if (!mission.matches.empty() && !options.overlap_only)
    estimate.matches = clock.time("matches", [&] {
      return close_by_matches(joint, mission, result.candidates, params, options, progress);
    });
}

/// The whole estimate, stage by stage.
template <class Pose>
RunOutput run(const Mission& mission, const TeamGraph<Pose>* team, const std::vector<ScanClosure>& loops,
              const RunParams& params, const RunOptions& options, const Progress& progress) {
  RunOutput output;
  RunResult& result = output.result;
  StageClock clock(result.timings);
  TeamEstimate<Pose> estimate{
      .radio = clock.time("radio", [&] { return measure_radio(mission, params.radio, progress); })};
  const RadioMeasurements& radio = estimate.radio;
  JointGraph<Pose>& joint = estimate.joint;
  joint = clock.time("graph", [&] { return make_joint_graph(mission, team, loops, params); });
  estimate.scan_ties = add_scan_closures(joint, loops, params.optimizer);
  if (has_fixes(mission))
    estimate.fixes = clock.time(
        "position fixes", [&] { return place_by_fixes(joint, mission, params.fixes, params.optimizer); });
  const auto with_starts = with_placed_starts<Pose>(mission, estimate.fixes);
  const Mission& placed = with_starts ? *with_starts : mission;
  estimate.placement =
      clock.time("team frame", [&] { return place_team(joint, placed, radio, params, progress); });
  hold_by_fixes(joint, estimate.fixes, estimate.placement);
  estimate.closures = clock.time("closures", [&] {
    return propose_fingerprint_closures(placed, radio, params.radio.distance_model.trusted_way_m,
                                        params.team_frame, params.closure);
  });
  add_fingerprint_closures(joint, radio, estimate.closures);
  estimate.sequences =
      clock.time("sequences", [&] { return add_sequence_closures(joint, radio, params.sequence); });
  estimate.solution = clock.time(
      "optimise", [&] { return optimize_robustly(joint, params.robust, params.optimizer, progress); });
  if (has_fixes(mission))
    clock.time("settle fixes", [&] { settle_fixes(joint, estimate.fixes, params.optimizer, progress); });
  clock.time("radio field", [&] {
    if (refine_by_radio_field(joint, placed, radio, estimate.placement, estimate.closures, params.field,
                              progress))
      optimize(joint.team.graph, params.optimizer, progress);
  });
  result.range_biases = clock.time("range biases", [&] {
    return estimate_range_biases(joint, params.range_bias, params.alignment.mixture, params.optimizer,
                                 progress);
  });
  compare_places(result, estimate, mission, params, options, progress, clock);
  add_run_results(result, mission, estimate, loops, params, options, clock);
  output.graph = std::move(joint.team.graph);
  return output;
}

RunOutput run_in_its_dimension(const Mission& mission, const std::vector<ScanClosure>& loops,
                               const RunParams& params, const RunOptions& options, const Progress& progress) {
  return mission.dimension == 2 ? run<SE2>(mission, nullptr, loops, params, options, progress)
                                : run<SE3>(mission, nullptr, loops, params, options, progress);
}

}  // namespace

RunOutput run_pipeline(const Mission& recorded, const RunParams& params, const RunOptions& options,
                       const Progress& progress) {
  if (!has_raw_recordings(recorded)) return run_in_its_dimension(recorded, {}, params, options, progress);
  Mission mission = recorded;
  MeasuredRecordings measured = measure_recordings(mission, params, progress);
  RunOutput output = run_in_its_dimension(mission, measured.scans.closures, params, options, progress);
  add_recording_results(output.result, std::move(measured), mission, params, options);
  return output;
}

template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options, const Progress& progress) {
  return run(mission, &team, {}, params, options, progress);
}

template RunOutput run_pipeline(const Mission&, const TeamGraph<SE2>&, const RunParams&, const RunOptions&,
                                const Progress&);
template RunOutput run_pipeline(const Mission&, const TeamGraph<SE3>&, const RunParams&, const RunOptions&,
                                const Progress&);

}  // namespace radioslam

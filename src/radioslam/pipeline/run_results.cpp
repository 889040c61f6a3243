#include "radioslam/pipeline/run_results.hpp"

#include <algorithm>

#include "radioslam/pipeline/collect_results.hpp"
#include "radioslam/pipeline/dense_trajectory.hpp"
#include "radioslam/pipeline/fix_results.hpp"
#include "radioslam/pipeline/honest_graph.hpp"

namespace radioslam {
namespace {

void count(RunResult& result, const RadioMeasurements& radio, const OptimizerSummary& summary) {
  const auto accepted = std::count_if(result.closures.begin(), result.closures.end(),
                                      [](const auto& c) { return c.status == ClosureStatus::kAccepted; });
  std::size_t keyframes = 0;
  for (const auto& robot : result.robots) keyframes += robot.estimate.size();
  result.counts["keyframes"] = static_cast<double>(keyframes);
  result.counts["fingerprints"] = static_cast<double>(radio.nodes.size());
  result.counts["closures_accepted"] = static_cast<double>(accepted);
  result.counts["closures_rejected"] =
      static_cast<double>(result.closures.size()) - static_cast<double>(accepted);
  result.counts["optimizer_iterations"] = summary.iterations;
}

/// What the run says about the estimate, its uncertainty and its alternatives.
template <class Pose>
void add_estimate(RunResult& result, const Mission& mission, const JointGraph<Pose>& joint,
                  const TeamPlacement<Pose>& placement, const MixtureParams& mixture, StageClock& clock) {
  const auto& graph = joint.team.graph;
  result.robots = collect_robots(joint, graph.poses, placement);
  const auto marginals =
      clock.time("uncertainty", [&] { return Marginals<Pose>::compute(honest(joint, mixture).team.graph); });
  if (marginals) {
    add_uncertainty(result.robots, joint, *marginals);
    result.transforms = collect_transforms(joint, placement, *marginals);
    for (auto& note : odometry_notes(mission, joint, *marginals)) result.notes.push_back(std::move(note));
  }
  result.weight = placement.weight;
  for (std::size_t k = 0; k < placement.alternatives.size(); ++k)
    result.alternatives.push_back(
        {placement.alternative_weights[k], collect_robots(joint, placement.alternatives[k], placement)});
  result.components = collect_components(joint, placement);
  for (const auto& robot : result.robots)
    if (!robot.placed) result.unplaced.push_back(robot.id);
}

void add_notes(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
               const SequenceStageParams& sequence, std::size_t ignored_links) {
  for (const auto& id : result.unplaced)
    result.notes.push_back("robot " + id + " is not placed: nothing ties it to another robot");
  for (const auto& file : mission.unused_files)
    result.notes.push_back(file + " took no part: this version does not use it");
  if (ignored_links > 0)
    result.notes.push_back(
        std::to_string(ignored_links) +
        " links were left out: no odometry at their time, or relative poses between robots");
  if (!result.alternatives.empty())
    result.notes.push_back("the links leave open how the team lies: see hypotheses/");
  if (const auto note = sequence_note(mission.dimension, radio, sequence)) result.notes.push_back(*note);
}

/// Is every robot where it says it is, and where the estimate has it?
template <class Pose>
void check_angles_into(RunResult& result, const Mission& mission, const JointGraph<Pose>& joint,
                       const TeamPlacement<Pose>& placement, const RunParams& params) {
  const auto add = [&](const AngleChecks& checks, CheckedPose pose) {
    result.angle_checks.insert(result.angle_checks.end(), checks.pairs.begin(), checks.pairs.end());
    for (auto& note : angle_notes(checks, pose)) result.notes.push_back(std::move(note));
  };
  add(check_claims<Pose>(mission, params.graph, params.angles, params.angle_check), CheckedPose::kClaim);
  add(check_estimate(mission, joint, placement, params.angles, params.angle_check), CheckedPose::kEstimate);
}

/// What became of every link and closure, by kind.
template <class Pose>
std::vector<ClosureResult> collect_all_closures(const TeamEstimate<Pose>& estimate,
                                                const std::vector<ScanClosure>& loops) {
  const JointGraph<Pose>& joint = estimate.joint;
  std::vector<ClosureResult> all = collect_radio_links(joint);
  for (auto& closure : collect_closures(estimate.radio, joint, estimate.closures))
    all.push_back(std::move(closure));
  for (auto& closure : collect_sequence_closures(joint, estimate.radio, estimate.sequences))
    all.push_back(std::move(closure));
  for (auto& closure : collect_scan_closures(joint, loops, estimate.scan_ties))
    all.push_back(std::move(closure));
  all.insert(all.end(), estimate.matches.begin(), estimate.matches.end());
  return all;
}

}  // namespace

template <class Pose>
void add_run_results(RunResult& result, const Mission& mission, const TeamEstimate<Pose>& estimate,
                     const std::vector<ScanClosure>& loops, const RunParams& params,
                     const RunOptions& options, StageClock& clock) {
  const RadioMeasurements& radio = estimate.radio;
  const JointGraph<Pose>& joint = estimate.joint;
  result.mission_name = mission.name;
  result.dimension = mission.dimension;
  add_estimate(result, mission, joint, estimate.placement, params.alignment.mixture, clock);
  for (std::size_t r = 0; r < mission.robots.size() && !options.overlap_only; ++r)
    result.robots[r].dense = dense_trajectory<Pose>(mission, joint, nullptr, r, result.robots[r]).poses;
  add_device_offsets(result.robots, radio.device_offsets);
  if (radio.device_offsets.shown) result.notes.push_back(device_offset_note(result.robots));
  add_notes(result, mission, radio, params.sequence, joint.ignored_links);
  add_fix_results(result, joint, estimate.fixes);
  if (!mission.arrivals.empty())
    clock.time("angle checks",
               [&] { check_angles_into(result, mission, joint, estimate.placement, params); });
  result.closures = collect_all_closures(estimate, loops);
  result.similarity_model = collect_similarity_model(radio, params.radio);
  clock.time("access points", [&] { add_access_points(result, mission, radio, params.access_points); });
  count(result, radio, estimate.solution);
}

template void add_run_results(RunResult&, const Mission&, const TeamEstimate<SE2>&,
                              const std::vector<ScanClosure>&, const RunParams&, const RunOptions&,
                              StageClock&);
template void add_run_results(RunResult&, const Mission&, const TeamEstimate<SE3>&,
                              const std::vector<ScanClosure>&, const RunParams&, const RunOptions&,
                              StageClock&);

}  // namespace radioslam

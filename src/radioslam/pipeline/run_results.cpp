#include "radioslam/pipeline/run_results.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "radioslam/inertial/imu_path.hpp"
#include "radioslam/joint/dense_trajectory.hpp"
#include "radioslam/joint/links/sight_notes.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/joint/uncertainty/rejected_stretches.hpp"
#include "radioslam/pipeline/collect_results.hpp"
#include "radioslam/places/loops/scan_loop.hpp"
#include "radioslam/results/result_notes.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxReportedAlternatives = 3;

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

/// Adds the estimate, its uncertainty and its alternatives.
template <class Pose>
void add_estimate(RunResult& result, const Mission& mission, const JointGraph<Pose>& joint,
                  const TeamAlignment<Pose>& alignment, const MixtureParams& mixture, StageClock& timed) {
  const auto& graph = joint.team.graph;
  result.robots = collect_robots(joint, graph.poses, alignment);
  const auto marginals = timed("uncertainty", [&] {
    return Marginals<Pose>::compute(graph_for_covariances(joint, mixture).team.graph);
  });
  if (marginals) {
    add_uncertainty(result.robots, joint, alignment, *marginals);
    widen_by_unknown_motions(result.robots, joint, *marginals);
    result.transforms = collect_transforms(joint, alignment, *marginals);
    for (auto& note : odometry_notes(mission, joint, *marginals)) result.notes.push_back(std::move(note));
    if (auto note = start_note(joint, *marginals)) result.notes.push_back(std::move(*note));
  }
  result.weight = alignment.weight;
  for (std::size_t k = 0; k < std::min(alignment.alternatives.size(), kMaxReportedAlternatives); ++k)
    result.alternatives.push_back(
        {alignment.alternative_weights[k], collect_robots(joint, alignment.alternatives[k], alignment)});
  result.components = collect_components(joint, alignment);
  for (const auto& robot : result.robots)
    if (!robot.placed) result.unplaced.push_back(robot.id);
}

/// Per robot its odometry with a row at each sample of the IMU that its scans were tracked with; empty
/// without.
std::vector<Trajectory<SE3>> imu_paths(const Mission& measured, const MeasuredScans& scans,
                                       const InertialParams& params) {
  std::vector<Trajectory<SE3>> paths(measured.robots.size());
  for (std::size_t r = 0; r < scans.robots.size(); ++r) {
    if (!scans.robots[r] || !scans.robots[r]->by_imu) continue;
    const auto& [first, last] = *scans.robots[r]->by_imu;
    const Robot& robot = measured.robots[r];
    const FilteredImu imu = remove_imu_outliers(robot.inertial, params.outliers);
    paths[r] = with_imu_path(robot.odometry, first, last, imu.samples, params.noise);
  }
  return paths;
}

/// Adds the continuous trajectories, also those of the alternatives.
template <class Pose>
void add_dense(RunResult& result, const Mission& measured, const std::vector<Trajectory<SE3>>& paths,
               const JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment) {
  const auto add = [&](const JointGraph<Pose>& of, std::vector<RobotResult>& robots) {
    for (std::size_t r = 0; r < robots.size(); ++r) {
      robots[r].dense = dense_trajectory<Pose>(measured, of, nullptr, r, robots[r]).poses;
      if (!paths[r].empty()) robots[r].dense = along_path<Pose>(robots[r].dense, paths[r]);
    }
  };
  add(joint, result.robots);
  for (std::size_t k = 0; k < result.alternatives.size(); ++k) {
    JointGraph<Pose> alternative = joint;
    alternative.team.graph.poses = alignment.alternatives[k];
    add(alternative, result.alternatives[k].robots);
  }
}

void append(std::vector<std::string>& notes, std::vector<std::string> more) {
  for (auto& note : more) notes.push_back(std::move(note));
}

void add_notes(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
               const SequenceStageParams& sequence, std::size_t ignored_links) {
  for (const auto& id : result.unplaced)
    result.notes.push_back("robot " + id +
                           " is not placed: no measurement that can be trusted connects it to another robot");
  append(result.notes, component_notes(result));
  for (const auto& file : mission.unused_files) result.notes.push_back(file + " is not used by this version");
  if (ignored_links > 0)
    result.notes.push_back(
        std::to_string(ignored_links) +
        " links are not used: they have no odometry at their time, or are relative poses between robots");
  if (auto note = range_bias_note(result.range_biases)) result.notes.push_back(std::move(*note));
  if (!result.alternatives.empty())
    result.notes.push_back("what was measured leaves the alignment ambiguous: see hypotheses/");
  if (const auto note = sequence_note(mission.dimension, radio, sequence)) result.notes.push_back(*note);
}

/// Tests self-reported and estimated poses against the angles of arrival.
template <class Pose>
void check_angles_into(RunResult& result, const Mission& mission, const JointGraph<Pose>& joint,
                       const TeamAlignment<Pose>& alignment, const RunParams& params) {
  const auto add = [&](const AoaIntegrity& checks, CheckedPose pose) {
    result.angle_checks.insert(result.angle_checks.end(), checks.pairs.begin(), checks.pairs.end());
    append(result.notes, angle_notes(checks, pose));
  };
  add(check_self_reports<Pose>(mission, params.graph, params.angles, params.angle_check),
      CheckedPose::kSelfReported);
  add(check_estimate(mission, joint, alignment, params.angles, params.angle_check), CheckedPose::kEstimate);
}

/// Adds the keyframe pairs with overlapping views and their counts. `streamed`: they have all been handed
/// over.
void add_overlaps(RunResult& result, const Mission& mission, OverlapStage overlaps, bool streamed) {
  if (!overlaps.searched) {
    result.notes.push_back("overlap search was skipped: the estimate's covariances are singular");
    return;
  }
  result.counts["pairs"] = static_cast<double>(overlaps.counts.pairs);
  result.counts["candidates"] = static_cast<double>(overlaps.counts.kept);
  const std::size_t listed = streamed ? overlaps.counts.kept : overlaps.listed.size();
  result.counts["candidates_listed"] = static_cast<double>(listed);
  result.counts["distances_evaluated"] = static_cast<double>(overlaps.counts.distances_evaluated);
  if (listed < overlaps.counts.kept)
    result.notes.push_back("candidates.csv lists the most probable " + std::to_string(listed) + " of " +
                           std::to_string(overlaps.counts.kept) +
                           " candidates (overlap.max_listed_candidates); prune lists all");
  result.candidates = std::move(overlaps.listed);
  result.exchange = std::move(overlaps.exchange);
  if (overlaps.estimated_links)
    result.notes.push_back(
        "mode link used relative poses of the joint estimate at the links: no range has a direct "
        "angle of arrival at both ends, in the plane, within overlap.pairing_s");
  for (const auto& [i, j] : overlaps.unlinked)
    result.notes.push_back("mode link did not compare " + mission.robots[i.index()].id + " and " +
                           mission.robots[j.index()].id + ": no link between them gives a relative pose");
  if (overlaps.alignments > 1)
    result.notes.push_back("the candidates are those of any of the " + std::to_string(overlaps.alignments) +
                           " likely team alignments");
}

std::string whole_seconds(Stamp stamp) { return std::to_string(std::llround(stamp.seconds())); }

/// Whether nothing but the similarity of fingerprints says where robots of unknown start are.
template <class Pose>
bool is_laid_out_by_fingerprints(const TeamEstimate<Pose>& team, const RadioMeasurements& radio) {
  const auto& robots = team.joint.robots;
  return !radio.nodes.empty() && robots.size() > 1 && team.alignment.segments.of_segment.empty() &&
         std::any_of(robots.begin(), robots.end(), [](const RobotVariables& robot) {
           return !robot.T_common_start && !robot.placed_by_fixes;
         });
}

/// Adds the stretches whose evidence was mostly rejected, and a note on each robot that has any.
void add_uncertain_stretches(RunResult& result) {
  auto stretches = rejected_stretches(result.robots.size(), result.closures);
  for (std::size_t r = 0; r < result.robots.size(); ++r) {
    RobotResult& robot = result.robots[r];
    robot.uncertain = std::move(stretches[r]);
    if (robot.uncertain.empty()) continue;
    std::string note =
        "the trajectory of robot " + robot.id + " is uncertain where most of its closures were rejected:";
    for (const auto& [first, last] : robot.uncertain)
      note += (&first == &robot.uncertain.front().first ? " " : ", ") + whole_seconds(first) + " to " +
              whole_seconds(last) + " s";
    result.notes.push_back(std::move(note));
  }
}

}  // namespace

template <class Pose>
std::vector<ClosureResult> collect_all_closures(const TeamEstimate<Pose>& estimate) {
  const JointGraph<Pose>& joint = estimate.joint;
  std::vector<ClosureResult> all = collect_radio_links(joint);
  for (auto& closure : collect_fingerprint_closures(joint)) all.push_back(std::move(closure));
  const auto& closures = estimate.measured.closures;
  const auto& judgements = estimate.judgement.closures;
  const auto add = [&](const auto& of_origin, const auto& judged) {
    for (auto& closure : collect_closures(joint, of_origin, judged)) all.push_back(std::move(closure));
  };
  add(closures.sequences, judgements.sequences);
  add(closures.scans, judgements.scans);
  add(closures.loops, judgements.loops);
  return all;
}

template <class Pose>
RunResult describe_run(const Mission& mission, const Mission& measured, const MeasuredScans& scans,
                       const RadioMeasurements& radio, const TeamEstimate<Pose>& estimate,
                       std::optional<OverlapStage> overlaps, const RunParams& params,
                       const RunOptions& options, StageClock& timed) {
  std::optional<JointGraph<Pose>> tied;
  if (has_untied_poses(estimate.joint, estimate.alignment)) {
    tied = estimate.joint;
    leave_out_untied_poses(*tied, estimate.alignment);
  }
  const JointGraph<Pose>& joint = tied ? *tied : estimate.joint;
  RunResult result;
  result.mission_name = mission.name;
  result.dimension = mission.dimension;
  result.range_biases = estimate.judgement.range_biases;
  result.loop_choice = estimate.judgement.loop_choice;
  if (overlaps) add_overlaps(result, mission, std::move(*overlaps), options.take_candidates != nullptr);
  add_estimate(result, mission, joint, estimate.alignment, params.alignment.mixture, timed);
  if (!options.overlap_only)
    add_dense(result, measured, imu_paths(measured, scans, params.scans.inertial), joint, estimate.alignment);
  add_rssi_offsets(result.robots, radio.rssi_offsets);
  if (is_laid_out_by_fingerprints(estimate, radio)) {
    widen_by_layout(result.robots, estimate.alignment);
    result.notes.push_back(
        "robots were placed by fingerprints alone: sigma_m and sigma_team_m hold what halves of the access "
        "points disagree on, not every error of the layout");
  }
  if (radio.rssi_offsets.shown) result.notes.push_back(rssi_offset_note(result.robots));
  add_notes(result, mission, radio, params.sequence, joint.ignored_links);
  if (auto note = untied_note(joint.robots)) result.notes.push_back(std::move(*note));
  append(result.notes, estimate.alignment.notes);
  add_fix_results(result, joint, estimate.judgement.fixes);
  if (!mission.aoa_measurements.empty())
    timed("angle checks", [&] { check_angles_into(result, mission, joint, estimate.alignment, params); });
  result.closures = collect_all_closures(estimate);
  append(result.notes, rejection_notes(result.closures));
  auto note = look_alike_note(result.closures, reason(LoopStatus::kAmbiguous));
  if (note && !has_known_starts(mission) && !has_fixes(mission)) {
    result.weight = std::min(result.weight, kMaxLookAlikeWeight);
    result.notes.push_back(std::move(*note));
  }
  append(result.notes, notes_on_obstructed_robots(result.robots, result.closures));
  add_uncertain_stretches(result);
  widen_by_alternatives(result.robots, joint, estimate.alignment);
  widen_by_rejected_closures(result.robots, result.closures);
  result.similarity_model = collect_similarity_model(radio, params.radio);
  timed("access points", [&] { add_access_points(result, mission, radio, params.access_points); });
  count(result, radio, estimate.solution);
  return result;
}

template std::vector<ClosureResult> collect_all_closures(const TeamEstimate<SE2>&);
template std::vector<ClosureResult> collect_all_closures(const TeamEstimate<SE3>&);
template RunResult describe_run(const Mission&, const Mission&, const MeasuredScans&,
                                const RadioMeasurements&, const TeamEstimate<SE2>&,
                                std::optional<OverlapStage>, const RunParams&, const RunOptions&,
                                StageClock&);
template RunResult describe_run(const Mission&, const Mission&, const MeasuredScans&,
                                const RadioMeasurements&, const TeamEstimate<SE3>&,
                                std::optional<OverlapStage>, const RunParams&, const RunOptions&,
                                StageClock&);

}  // namespace radioslam

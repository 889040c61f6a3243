#include "radioslam/pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <type_traits>

#include "radioslam/pipeline/collect_results.hpp"
#include "radioslam/pipeline/csi_arrivals.hpp"
#include "radioslam/pipeline/csi_stage.hpp"
#include "radioslam/pipeline/dense_trajectory.hpp"
#include "radioslam/pipeline/field_stage.hpp"
#include "radioslam/pipeline/fix_results.hpp"
#include "radioslam/pipeline/fix_stage.hpp"
#include "radioslam/pipeline/joint_graph_of_team.hpp"
#include "radioslam/pipeline/scan_closures.hpp"
#include "radioslam/pipeline/scan_picture.hpp"
#include "radioslam/team_frame/observed_information.hpp"

namespace radioslam {
namespace {

/// Wall time per stage, in the order of the stages.
class StageClock {
 public:
  explicit StageClock(std::vector<StageTiming>& timings) : timings_(timings) {}

  /// Runs `stage` and notes how long it took.
  template <class Work>
  auto time(std::string_view stage, Work&& work) {
    const auto begin = Clock::now();
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      note(stage, begin);
    } else {
      auto result = work();
      note(stage, begin);
      return result;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void note(std::string_view stage, Clock::time_point begin) {
    const std::chrono::duration<double> spent = Clock::now() - begin;
    timings_.push_back({std::string(stage), spent.count()});
  }

  std::vector<StageTiming>& timings_;
};

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

/// With weights for covariances instead of for the estimate.
template <class Pose>
JointGraph<Pose> honest(const JointGraph<Pose>& joint, const MixtureParams& mixture) {
  JointGraph<Pose> result = joint;
  discount_uncertain_measurements(result.team.graph, joint.first_closure_range, mixture.sigma_place_m);
  return result;
}

/// What the run says about the estimate in `joint`.
template <class Pose>
void collect(RunResult& result, const Mission& mission, const JointGraph<Pose>& joint,
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

template <class Pose>
RunOutput run(const Mission& mission, const TeamGraph<Pose>* team, const std::vector<ScanClosure>& loops,
              const RunParams& params, const RunOptions& options, const Progress& progress) {
  RunOutput output;
  RunResult& result = output.result;
  StageClock clock(result.timings);

  const auto radio = clock.time("radio", [&] { return measure_radio(mission, params.radio, progress); });
  auto joint = clock.time("graph", [&] {
    if (team) return joint_graph_of(*team, mission);
    std::vector<std::vector<Stamp>> moments(mission.robots.size());
    add_closure_moments(loops, moments);
    add_fix_moments(mission, moments);
    return build_joint_graph<Pose>(mission, params.keyframe, params.graph, std::move(moments));
  });
  const ScanTies scan_ties = add_scan_closures(joint, loops, params.optimizer);
  TeamFixes<Pose> fixes;
  if (has_fixes(mission))
    fixes = clock.time("position fixes",
                       [&] { return place_by_fixes(joint, mission, params.fixes, params.optimizer); });
  const auto with_starts = with_placed_starts<Pose>(mission, fixes);
  const Mission& placed = with_starts ? *with_starts : mission;
  const auto placement = clock.time("team frame", [&] {
    return has_radio_links(joint) ? place_by_radio(joint, params.alignment, progress)
                                  : place_by_fingerprints(joint, placed, radio, params.team_frame, progress);
  });
  hold_by_fixes(joint, fixes, placement);
  auto closures = clock.time("closures", [&] {
    return propose_fingerprint_closures(placed, radio, params.radio.distance_model.trusted_way_m,
                                        params.team_frame, params.closure);
  });
  add_fingerprint_closures(joint, radio, closures);
  const auto sequences =
      clock.time("sequences", [&] { return add_sequence_closures(joint, radio, params.sequence); });
  const auto solution = clock.time(
      "optimise", [&] { return optimize_robustly(joint, params.robust, params.optimizer, progress); });
  if (has_fixes(mission))
    clock.time("settle fixes", [&] { settle_fixes(joint, fixes, params.optimizer, progress); });
  clock.time("radio field", [&] {
    if (refine_by_radio_field(joint, placed, radio, placement, closures, params.field, progress))
      optimize(joint.team.graph, params.optimizer, progress);
  });
  result.range_biases = clock.time("range biases", [&] {
    return estimate_range_biases(joint, params.range_bias, params.alignment.mixture, params.optimizer,
                                 progress);
  });

  if (wants_overlaps(mission, options))
    clock.time("overlap", [&] {
      search_overlaps_into(result, honest(joint, params.alignment.mixture), params, options);
    });
  std::vector<ClosureResult> matches;
  if (!mission.matches.empty() && !options.overlap_only)
    matches = clock.time("matches", [&] {
      return close_by_matches(joint, mission, result.candidates, params, options, progress);
    });

  result.mission_name = mission.name;
  result.dimension = mission.dimension;
  collect(result, mission, joint, placement, params.alignment.mixture, clock);
  for (std::size_t r = 0; r < mission.robots.size() && !options.overlap_only; ++r)
    result.robots[r].dense = dense_trajectory<Pose>(mission, joint, nullptr, r, result.robots[r]).poses;
  add_device_offsets(result.robots, radio.device_offsets);
  if (radio.device_offsets.shown) result.notes.push_back(device_offset_note(result.robots));
  add_notes(result, mission, radio, params.sequence, joint.ignored_links);
  add_fix_results(result, joint, fixes);
  if (!mission.arrivals.empty())
    clock.time("angle checks", [&] { check_angles_into(result, mission, joint, placement, params); });
  result.closures = collect_radio_links(joint);
  for (auto& closure : collect_closures(radio, joint, closures))
    result.closures.push_back(std::move(closure));
  for (auto& closure : collect_sequence_closures(joint, radio, sequences))
    result.closures.push_back(std::move(closure));
  for (auto& closure : collect_scan_closures(joint, loops, scan_ties))
    result.closures.push_back(std::move(closure));
  result.closures.insert(result.closures.end(), matches.begin(), matches.end());
  result.similarity_model = collect_similarity_model(radio, params.radio);
  clock.time("access points", [&] { add_access_points(result, mission, radio, params.access_points); });
  count(result, radio, solution);
  output.graph = std::move(joint.team.graph);
  return output;
}

RunOutput run_in_its_dimension(const Mission& mission, const std::vector<ScanClosure>& loops,
                               const RunParams& params, const RunOptions& options, const Progress& progress) {
  return mission.dimension == 2 ? run<SE2>(mission, nullptr, loops, params, options, progress)
                                : run<SE3>(mission, nullptr, loops, params, options, progress);
}

/// Scans or captures, of which odometry and angles have to be made first.
bool has_raw_recordings(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty() || robot.csi; });
}

void count_scans(RunResult& result, const MeasuredScans& scans) {
  result.counts["scans"] = static_cast<double>(scans.scans);
  result.counts["scans_registered"] = static_cast<double>(scans.registered);
  result.counts["scans_of_few_points"] = static_cast<double>(scans.too_few);
  result.counts["scans_lost"] = static_cast<double>(scans.unmatched);
  result.counts["scan_closures_accepted"] =
      static_cast<double>(std::count_if(result.closures.begin(), result.closures.end(), [](const auto& c) {
        return c.kind == ClosureKind::kLidar && c.status == ClosureStatus::kAccepted;
      }));
}

bool has_scans(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty(); });
}

/// The angles measured in the mission's captures in place of the captures.
void add_angles(Mission& mission, const std::vector<ArrivalMeasurement>& measured) {
  for (Robot& robot : mission.robots) robot.csi.reset();
  mission.arrivals.insert(mission.arrivals.end(), measured.begin(), measured.end());
  std::stable_sort(mission.arrivals.begin(), mission.arrivals.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
}

}  // namespace

RunOutput run_pipeline(const Mission& recorded, const RunParams& params, const RunOptions& options,
                       const Progress& progress) {
  if (!has_raw_recordings(recorded)) return run_in_its_dimension(recorded, {}, params, options, progress);
  std::vector<StageTiming> timings;
  StageClock clock(timings);
  Mission mission = recorded;
  const MeasuredScans scans =
      clock.time("scans", [&] { return measure_scans(mission, params.scans, params.keyframe, progress); });
  MeasuredCsi csi = clock.time("angles", [&] { return measure_csi(mission, params.csi, progress); });
  add_angles(mission, csi.arrivals);
  RunOutput output = run_in_its_dimension(mission, scans.closures, params, options, progress);
  RunResult& result = output.result;
  if (csi.arrivals.empty() && csi.notes.empty()) timings.pop_back();
  if (scans.scans == 0) timings.erase(timings.begin());
  result.timings.insert(result.timings.begin(), timings.begin(), timings.end());
  if (scans.scans > 0) count_scans(result, scans);
  if (has_scans(mission) && !options.overlap_only)
    StageClock(result.timings).time("scan picture", [&] {
      add_scan_pictures(result, mission, params.scans.lidar, params.scan_picture);
    });
  if (!csi.arrivals.empty() || !csi.notes.empty())
    result.counts["arrivals_measured"] = static_cast<double>(csi.arrivals.size());
  result.notes.insert(result.notes.end(), scans.notes.begin(), scans.notes.end());
  for (auto& note : csi.notes) result.notes.push_back(std::move(note));
  add_estimated_azimuths(csi.profiles, result.robots);
  result.arrivals = std::move(csi.profiles);
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

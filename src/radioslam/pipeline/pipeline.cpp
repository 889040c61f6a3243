#include "radioslam/pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>

#include "radioslam/pipeline/collect_results.hpp"

namespace radioslam {
namespace {

/// Wall time per stage, in the order of the stages.
class StageClock {
 public:
  explicit StageClock(std::vector<StageTiming>& timings) : timings_(timings) {}

  /// Runs `stage` and notes how long it took.
  template <class Work>
  auto time(std::string_view stage, Work&& work) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = work();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    timings_.push_back({std::string(stage), spent.count()});
    return result;
  }

 private:
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

template <class Pose>
RunOutput run(const Mission& mission, const RunParams& params, const Progress& progress) {
  RunOutput output;
  RunResult& result = output.result;
  StageClock clock(result.timings);

  const auto radio = clock.time("radio", [&] { return measure_radio(mission, params.radio, progress); });
  const auto team_frame = clock.time(
      "team frame", [&] { return align_by_fingerprints(mission, radio, params.team_frame, progress); });
  const auto closures = clock.time("closures", [&] {
    return propose_fingerprint_closures(mission, radio, params.radio.distance_model.trusted_way_m,
                                        params.team_frame, params.closure);
  });
  auto joint = clock.time("graph", [&] {
    return build_joint_graph<Pose>(mission, params.keyframe, radio, team_frame, closures, params.graph);
  });
  const auto solution = clock.time(
      "optimise", [&] { return optimize_robustly(joint, params.robust, params.optimizer, progress); });

  result.mission_name = mission.name;
  result.dimension = mission.dimension;
  result.robots = collect_robots(mission, joint, team_frame);
  const auto marginals = clock.time("uncertainty", [&] { return Marginals<Pose>::compute(joint.graph); });
  if (marginals) {
    add_uncertainty(result.robots, joint, *marginals);
    result.notes = odometry_notes(mission, joint, *marginals);
  }
  for (const auto& file : mission.unused_files)
    result.notes.push_back(file + " took no part: this version does not use it");
  result.closures = collect_closures(radio, joint, closures);
  result.similarity_model = collect_similarity_model(radio, params.radio);
  result.components = collect_components(mission, team_frame);
  for (const auto& robot : result.robots)
    if (!robot.placed) result.unplaced.push_back(robot.id);
  for (const auto& id : result.unplaced)
    result.notes.push_back("robot " + id + " is not placed: nothing ties it to another robot");
  count(result, radio, solution);
  output.graph = std::move(joint.graph);
  return output;
}

}  // namespace

RunOutput run_pipeline(const Mission& mission, const RunParams& params, const Progress& progress) {
  return mission.dimension == 2 ? run<SE2>(mission, params, progress) : run<SE3>(mission, params, progress);
}

}  // namespace radioslam

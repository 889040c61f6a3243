#include "radioslam/study/evaluated_run.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/eval/team_estimate.hpp"

namespace radioslam {
namespace {

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<KeyframeStamps> keyframe_stamps(const RunResult& result) {
  std::vector<KeyframeStamps> stamps;
  for (const RobotResult& robot : result.robots) stamps.push_back(robot.estimate.stamps());
  return stamps;
}

double seconds_of(const RunResult& result, std::string_view stage) {
  for (const StageTiming& timing : result.timings)
    if (timing.stage == stage) return timing.seconds;
  return 0;
}

std::optional<double> best_ate_m(const RunResult& result, const Truth& truth,
                                 std::optional<double> likeliest) {
  std::optional<double> best = likeliest;
  for (const HypothesisResult& other : result.alternatives) {
    const auto ate = ate_rmse_m(team_estimate(other.robots, result), truth, result.dimension);
    if (ate && (!best || *ate < *best)) best = ate;
  }
  return best;
}

}  // namespace

std::optional<double> recall(const PairCounts& counts) { return share(counts.true_kept, counts.true_pairs); }

std::optional<double> rejected_false(const PairCounts& counts) {
  const std::size_t false_pairs = counts.pairs - counts.true_pairs;
  const std::size_t false_kept = counts.kept - counts.true_kept;
  return share(false_pairs - false_kept, false_pairs);
}

std::optional<double> ate_rmse_m(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                 int dimension) {
  const TeamMetrics metrics = evaluate_trajectories(estimate, truth, dimension);
  if (!metrics.ate) return std::nullopt;
  return metrics.ate->rmse_m;
}

Mission without_radio(const Mission& mission) {
  Mission result = mission;
  result.ranges.clear();
  result.aoa_measurements.clear();
  return result;
}

std::optional<double> dead_reckoning_ate_m(const Mission& mission, const Truth& truth) {
  std::vector<EstimatedTrajectory> robots;
  for (const Robot& robot : mission.robots) {
    if (!robot.initial_pose) return std::nullopt;
    const SE3 T_common_frame = *robot.initial_pose * robot.odometry.front().pose.inverse();
    std::vector<StampedPose<SE3>> poses(robot.odometry.begin(), robot.odometry.end());
    for (auto& row : poses) row.pose = T_common_frame * row.pose;
    robots.push_back({robot.id, Trajectory<SE3>(std::move(poses))});
  }
  return ate_rmse_m(robots, truth, mission.dimension);
}

namespace {

EvaluatedRun evaluated(const RunResult& result, const Mission& mission, const Truth& truth,
                       const RunParams& params) {
  EvaluatedRun run;
  run.estimate = team_estimate(result);
  const TeamMetrics metrics = evaluate_trajectories(run.estimate, truth, result.dimension);
  if (metrics.ate) run.ate_m = metrics.ate->rmse_m;
  run.best_ate_m = best_ate_m(result, truth, run.ate_m);
  run.weight = result.weight;
  run.coverage = metrics.coverage;
  const OverlapStageParams& overlap = params.overlap;
  const auto radius_m = overlap.radius_m > 0 ? std::optional(overlap.radius_m) : std::nullopt;
  const PairTruth true_pairs = pair_truth(mission, truth, radius_m, overlap.overlap.min_shared_view);
  run.candidates = count_candidates(keyframe_stamps(result), result.candidates, true_pairs);
  const auto distances = result.counts.find("distances_evaluated");
  if (distances != result.counts.end()) run.distances_evaluated = distances->second;
  run.search_s = seconds_of(result, "overlap");
  for (const StageTiming& timing : result.timings) run.total_s += timing.seconds;
  return run;
}

RunParams with_all_candidates(RunParams params) {
  params.overlap.max_listed_candidates = std::numeric_limits<int>::max();
  return params;
}

}  // namespace

EvaluatedRun run_and_evaluate(const Mission& mission, const Truth& truth, const RunParams& params,
                              const RunOptions& options) {
  return evaluated(run_pipeline(mission, with_all_candidates(params), options).result, mission, truth,
                   params);
}

EvaluatedRun run_and_evaluate(const Mission& mission, const MeasuredRecordings& recordings,
                              const Truth& truth, const RunParams& params, const RunOptions& options) {
  return evaluated(run_pipeline(mission, recordings, with_all_candidates(params), options).result, mission,
                   truth, params);
}

}  // namespace radioslam

#include "radioslam/study/wi_closure/place_study.hpp"

#include <memory>
#include <string>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/eval/team_estimate.hpp"

namespace radioslam {
namespace {

/// Simulated scans are computed when they are read, which would count as time of every run.
LidarLog held_in_memory(const LidarLog& log) {
  const auto scans = std::make_shared<std::vector<LidarScan>>(log.size());
  parallel_for(log.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      LidarScan& scan = (*scans)[k] = log.read(k);
      scan.points.shrink_to_fit();
      scan.times_s.shrink_to_fit();
    }
  });
  return {log.stamps, [scans](std::size_t k) { return (*scans)[k]; }};
}

PlaceCounts place_counts(const RunResult& result) {
  const auto count = [&](const char* key) {
    const auto found = result.counts.find(key);
    return found == result.counts.end() ? std::size_t{0} : static_cast<std::size_t>(found->second);
  };
  return {.pairs = count("place_pairs"),
          .allowed = count("place_pairs_allowed"),
          .compared = count("descriptor_pairs"),
          .proposed = count("registrations_proposed"),
          .registrations = count("registrations"),
          .verified = count("registrations_verified"),
          .bytes = {count("descriptor_bytes"), count("scan_bytes")},
          .bytes_all = {count("descriptor_bytes_all"), count("scan_bytes_all")}};
}

/// Of all stages, or of those with this name.
double stage_seconds(const RunResult& result, const std::string& stage = {}) {
  double sum_s = 0;
  for (const StageTiming& timing : result.timings)
    if (stage.empty() || timing.stage == stage) sum_s += timing.seconds;
  return sum_s;
}

std::vector<Eigen::Vector2d> positions(const Trajectory<SE3>& trajectory, const SE3& T) {
  constexpr std::size_t kMostDrawn = 400;
  const std::size_t step = 1 + trajectory.size() / kMostDrawn;
  std::vector<Eigen::Vector2d> result;
  for (std::size_t k = 0; k < trajectory.size(); k += step)
    result.push_back((T * trajectory[k].pose).translation().head<2>());
  return result;
}

void add_paths(const std::vector<EstimatedTrajectory>& aligned_together, const Truth& truth, int dimension,
               std::vector<RobotPath>& paths) {
  const SE3 T = evaluate_trajectories(aligned_together, truth, dimension).T_truth_estimate;
  for (const EstimatedTrajectory& robot : aligned_together)
    for (const RobotTruth& of : truth.robots)
      if (of.id == robot.id)
        paths.push_back({robot.id, positions(of.poses, SE3()), positions(robot.poses, T)});
}

PlaceRun place_run(const RunResult& result, const Truth& truth) {
  PlaceRun run;
  run.places = place_counts(result);
  run.closures = count_place_closures(result, truth);
  run.in_one_frame = result.components.size() == 1 && result.unplaced.empty();
  const std::vector<EstimatedTrajectory> estimate = team_estimate(result);
  if (run.in_one_frame) {
    run.ate_m = ate_rmse_m(estimate, truth, result.dimension);
    add_paths(estimate, truth, result.dimension, run.paths);
  } else {
    for (const EstimatedTrajectory& robot : estimate) add_paths({robot}, truth, result.dimension, run.paths);
  }
  run.scans_s = stage_seconds(result, "scans");
  run.overlap_s = stage_seconds(result, "overlap");
  run.places_s = stage_seconds(result, "places");
  run.total_s = stage_seconds(result);
  return run;
}

constexpr double kWithin = 1e-3;  // sigma from being near enough: none, but for rounding

}  // namespace

PlaceStudy study_places(Simulation simulation, std::uint64_t seed, const std::vector<PlaceSettings>& settings,
                        const RunParams& params, double radius_m, const Progress& progress) {
  RADIOSLAM_CHECK(!settings.empty(), "a study of places has parameters of place recognition");
  const std::size_t runs = 4 * settings.size();
  std::size_t done = 0;
  const auto next = [&] {
    report_progress(progress, "runs", static_cast<double>(done++) / static_cast<double>(runs));
  };
  for (Robot& robot : simulation.mission.robots) robot.lidar = held_in_memory(robot.lidar);
  const auto& [mission, truth] = simulation;
  const Mission scans_alone = without_radio(mission);

  PlaceStudy study;
  study.seed = seed;
  RunOptions search, unpruned;
  search.overlap_only = true;
  unpruned.pruning = Pruning::kOff;
  RunParams searched = params;
  searched.overlap.overlap.min_shared_view = params.places.min_shared_view;
  for (const PlaceSettings set : settings) {
    RunParams of_set = params;
    of_set.places = place_params(set, mission.robots.front().lidar_range_m);
    of_set.consistency = consistency_params(set);
    StageClock timed;
    next();
    MeasuredRecordings recordings = measure_recordings(mission, of_set, {}, timed);
    const auto run = [&](const Mission& of, const RunOptions& options) {
      next();
      return run_pipeline(of, recordings, of_set, options, timed).result;
    };
    PlaceRuns& of = study.runs.emplace_back();
    of.settings = set;
    if (study.runs.size() == 1) {
      study.search = run_and_evaluate(mission, recordings, truth, searched, search);
      if (radius_m > 0) {
        searched.overlap.radius_m = study.radius_m = radius_m;
        searched.overlap.overlap.max_mahalanobis = kWithin;
        study.within_radius = run_and_evaluate(mission, recordings, truth, searched, search);
      }
    }
    of.unpruned = place_run(run(mission, unpruned), truth);
    const RunResult pruned = run(mission, {});
    of.pruned = place_run(pruned, truth);
    if (study.runs.size() == 1) study.angles = compare_angle_paths(pruned, mission, truth);
    if (recordings.mission) recordings.mission = without_radio(*recordings.mission);
    of.without_radio = place_run(run(scans_alone, {}), truth);
  }
  report_progress(progress, "runs", 1);
  return study;
}

}  // namespace radioslam

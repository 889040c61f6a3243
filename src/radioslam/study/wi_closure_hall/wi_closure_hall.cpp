#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

#include <memory>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/eval/team_estimate.hpp"

namespace radioslam {
namespace {

/// Simulated scans are computed when they are read, which would count as time of every run.
LidarLog held_in_memory(const LidarLog& log) {
  const auto scans = std::make_shared<std::vector<LidarScan>>(log.size());
  parallel_for(log.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) (*scans)[k] = log.read(k);
  });
  return {log.stamps, [scans](std::size_t k) { return (*scans)[k]; }};
}

Simulation scan_hall(const HallParams& scenario, std::uint64_t seed) {
  Simulation simulation = simulate_hall(scenario, seed);
  for (Robot& robot : simulation.mission.robots) robot.lidar = held_in_memory(robot.lidar);
  return simulation;
}

Mission scans_alone(const Mission& mission) {
  Mission result = mission;
  result.ranges.clear();
  result.aoa_measurements.clear();
  return result;
}

PlaceCounts place_counts(const RunResult& result) {
  const auto count = [&](const char* key) {
    const auto found = result.counts.find(key);
    return found == result.counts.end() ? std::size_t{0} : static_cast<std::size_t>(found->second);
  };
  return {count("place_pairs"), count("place_pairs_allowed"), count("descriptor_pairs"),
          count("registrations"), count("registrations_verified")};
}

/// Of all stages, or of those with this name.
double stage_seconds(const RunResult& result, const std::string& stage = {}) {
  double sum_s = 0;
  for (const StageTiming& timing : result.timings)
    if (stage.empty() || timing.stage == stage) sum_s += timing.seconds;
  return sum_s;
}

HallRun hall_run(const RunResult& result, const Truth& truth) {
  HallRun run;
  run.places = place_counts(result);
  run.closures = count_place_closures(result, truth);
  run.in_one_frame = result.components.size() == 1 && result.unplaced.empty();
  if (run.in_one_frame) run.ate_m = ate_rmse_m(team_estimate(result), truth, result.dimension);
  run.scans_s = stage_seconds(result, "scans");
  run.overlap_s = stage_seconds(result, "overlap");
  run.places_s = stage_seconds(result, "places");
  run.total_s = stage_seconds(result);
  return run;
}

constexpr int kDiscoRings = 64, kDiscoSectors = 60, kDiscoNearestKeys = 50;
constexpr double kDiscoDistance = 0.2, kLoosenedDistance = 1;
constexpr int kDiscoCandidates = 1, kLoosenedCandidates = 10;

}  // namespace

HallParams scanned_hall() {
  constexpr int kBeams = 16;
  HallParams scenario;
  scenario.onboard.lidar.lidar_beams = kBeams;
  scenario.matches.matches_true = scenario.matches.matches_false = 0;
  return scenario;
}

PlaceParams place_params(PlaceSettings settings, double lidar_range_m) {
  PlaceParams params;
  if (settings == PlaceSettings::kDefaults) return params;
  const bool loosened = settings == PlaceSettings::kLoosenedDisco;
  params.rounds = 1;
  params.candidates = loosened ? kLoosenedCandidates : kDiscoCandidates;
  params.max_descriptor_distance = loosened ? kLoosenedDistance : kDiscoDistance;
  params.context.rings = kDiscoRings;
  params.context.sectors = kDiscoSectors;
  params.context.max_range_m = lidar_range_m;
  params.index.key = "ring";
  params.index.nearest_keys = kDiscoNearestKeys;
  return params;
}

const char* word_for(PlaceSettings settings) {
  switch (settings) {
    case PlaceSettings::kDefaults:
      return "defaults";
    case PlaceSettings::kDisco:
      return "DiSCo-SLAM";
    case PlaceSettings::kLoosenedDisco:
      return "loosened";
  }
  return "";
}

WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed,
                                        const Progress& progress) {
  constexpr int kRuns = 1 + 3 * static_cast<int>(kAllPlaceSettings.size());
  int done = 0;
  const auto next = [&] { report_progress(progress, "runs", static_cast<double>(done++) / kRuns); };
  const auto [mission, truth] = scan_hall(scenario, seed);
  const Mission without_radio = scans_alone(mission);

  WiClosureHall hall;
  hall.seed = seed;
  hall.scenario = scenario;
  RunOptions search, unpruned;
  search.overlap_only = true;
  unpruned.pruning = Pruning::kOff;
  RunParams searched;
  searched.overlap.overlap.min_shared_view = searched.places.min_shared_view;
  next();
  hall.search = run_and_evaluate(mission, truth, searched, search);

  for (std::size_t k = 0; k < kAllPlaceSettings.size(); ++k) {
    RunParams params;
    params.places = place_params(kAllPlaceSettings[k], scenario.lidar_range_m);
    next();
    hall.runs[k].without_radio = hall_run(run_pipeline(without_radio, params).result, truth);
    next();
    hall.runs[k].unpruned = hall_run(run_pipeline(mission, params, unpruned).result, truth);
    next();
    const RunResult pruned = run_pipeline(mission, params).result;
    hall.runs[k].pruned = hall_run(pruned, truth);
    if (kAllPlaceSettings[k] == PlaceSettings::kDefaults)
      hall.angles = judge_angle_paths(pruned, mission, truth);
  }
  report_progress(progress, "runs", 1);
  return hall;
}

}  // namespace radioslam

#include "radioslam/study/wi_closure_kitti/wi_closure_kitti.hpp"

#include "radioslam/study/oracle.hpp"

namespace radioslam {
namespace {

/// The mission with its true matches only.
Mission with_true_matches(const Mission& mission, const Truth& truth) {
  Mission result = mission;
  result.matches.clear();
  for (std::size_t k = 0; k < mission.matches.size(); ++k)
    if (truth.true_matches[k].value_or(false)) result.matches.push_back(mission.matches[k]);
  return result;
}

Mission without_matches(const Mission& mission) {
  Mission result = mission;
  result.matches.clear();
  return result;
}

Mission without_radio(const Mission& mission) {
  Mission result = mission;
  result.ranges.clear();
  result.aoa_measurements.clear();
  return result;
}

RunParams in_mode(const char* mode) {
  RunParams params;
  params.overlap.mode = mode;
  return params;
}

}  // namespace

KittiParams wi_closure_drive() {
  KittiParams scenario;
  scenario.matches.matches_true = 40;
  scenario.matches.matches_false = 120;
  return scenario;
}

WiClosureKitti reproduce_wi_closure_kitti(const RecordedDrive& drive, const KittiParams& scenario,
                                          std::uint64_t seed, const Progress& progress) {
  const Simulation simulation = simulate_kitti(scenario, drive, seed);
  const Mission& mission = simulation.mission;
  const Truth& truth = simulation.truth;
  const Mission bare = without_matches(mission);

  constexpr int kEstimates = 9;
  int done = 0;
  const auto next = [&](const Mission& recorded, const RunParams& params, const RunOptions& options) {
    report_progress(progress, "estimates", static_cast<double>(done++) / kEstimates);
    return run_and_evaluate(recorded, truth, params, options);
  };
  RunOptions search, unpruned;
  search.overlap_only = true;
  unpruned.pruning = Pruning::kOff;

  const RunParams joint = in_mode("joint"), link = in_mode("link");
  RunParams least_squares = joint;
  least_squares.matches.robust = false;

  WiClosureKitti result;
  result.seed = seed;
  result.scenario = scenario;
  result.joint = {next(bare, joint, search), next(mission, joint, {})};
  result.link = {next(bare, link, search), next(mission, link, {})};
  result.without_radio = next(without_radio(mission), joint, {});
  result.unpruned = next(mission, joint, unpruned);
  result.least_squares = next(mission, least_squares, unpruned);
  result.true_matches = next(with_true_matches(mission, truth), joint, {});
  report_progress(progress, "estimates", static_cast<double>(done) / kEstimates);
  if (const auto oracle = oracle_estimate(mission, truth, {}, result.joint.search.estimate))
    result.ate_oracle_m = ate_rmse_m(*oracle, truth, mission.dimension);
  return result;
}

}  // namespace radioslam

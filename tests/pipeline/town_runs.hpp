// Runs of small simulated towns for pipeline tests, and their errors.
#pragma once

#include "radioslam/eval/metrics.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam::test {

/// Two robots that drive this far each, odometry samples (and keyframes) 4.4 m apart.
inline CityParams small_city(double way_m) {
  CityParams params;
  params.path_length_m = way_m;
  params.min_contact_s = 10;
  params.streets.blocks_x = 3;
  params.streets.blocks_y = 3;
  params.odometry.odometry_rate_hz = 2.5;
  params.radio.links = 25;
  return params;
}

/// As accurate on so small a team, and several times as fast.
inline RunParams quick_params() {
  RunParams params;
  params.alignment.grid.references = 4;
  params.alignment.grid.angle_steps = 40;
  params.alignment.beam.tried_places = 24;
  params.alignment.beam.refined_places = 6;
  return params;
}

/// Root mean square over the whole team after one alignment.
inline double error_m(const RunResult& result, const Truth& truth) {
  std::vector<EstimatedTrajectory> estimate;
  for (const auto& robot : result.robots) estimate.push_back({robot.id, robot.estimate});
  return evaluate_trajectories(estimate, truth, 2).ate->rmse_m;
}

}  // namespace radioslam::test

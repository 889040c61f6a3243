#include "radioslam/study/fingerprints/fingerprint_tables.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/fingerprints/published_fingerprint_slam.hpp"
#include "radioslam/study/progress_counter.hpp"

namespace radioslam {
namespace {

constexpr int kDimension = 2;
constexpr std::array<std::size_t, 3> kTeamMeasures{0, 1, 3};  // those of tables II and III

template <std::size_t N, class Value>
std::optional<std::size_t> node_position(const Value& value, const std::array<Value, N>& values) {
  const auto found = std::find(values.begin(), values.end(), value);
  if (found == values.end()) return std::nullopt;
  return static_cast<std::size_t>(found - values.begin());
}

RadioParams published_radio(const FingerprintMeasure& measure) {
  RadioParams params;
  params.fingerprint.window_path_m = std::numeric_limits<double>::infinity();
  params.distance_model.even_distances = false;
  params.measure = measure.measure;
  params.similarity.sigma_detection = measure.sigma_detection;
  params.rssi_offset.prior_sigma_db = 0;
  return params;
}

/// All pairs for which the distance model predicts a distance.
struct MeasuredPairs {
  RadioMeasurements radio;
  std::vector<FingerprintClosure> pairs;
};

/// Constraints of algorithm 1 without a threshold: d(s) and sigma(s), all with full weight.
MeasuredPairs measure_pairs(const Mission& mission, const FingerprintMeasure& measure) {
  constexpr double kNoThreshold = std::numeric_limits<double>::infinity();
  const RadioParams params = published_radio(measure);
  FingerprintClosureParams all;
  all.within_distance_m = all.between_distance_m = kNoThreshold;
  RadioMeasurements radio = measure_radio(mission, params, {});
  auto pairs = propose_near_closures(radio, params.distance_model.max_trusted_path_m, all);
  for (FingerprintClosure& pair : pairs) {
    pair.predicted.peak_m = pair.predicted.mean_m;
    pair.predicted.spread_m = pair.predicted.sigma_m;
    pair.weight = 1;
  }
  return {std::move(radio), std::move(pairs)};
}

std::vector<FingerprintClosure> near_pairs(const MeasuredPairs& measured, const FingerprintCell& cell) {
  const auto robot = [&](std::size_t node) { return measured.radio.nodes[node].robot; };
  std::vector<FingerprintClosure> near;
  for (const FingerprintClosure& pair : measured.pairs) {
    const bool within = robot(pair.node_i) == robot(pair.node_j);
    if (pair.predicted.mean_m < (within ? cell.nu_within_m : cell.nu_between_m)) near.push_back(pair);
  }
  return near;
}

std::vector<EstimatedTrajectory> trajectories(const JointGraph<SE2>& joint) {
  std::vector<EstimatedTrajectory> robots;
  for (const RobotVariables& robot : joint.robots) {
    std::vector<StampedPose<SE3>> poses;
    for (std::size_t k = 0; k < robot.stamps.size(); ++k)
      poses.push_back({robot.stamps[k], lift(joint.team.graph.poses[robot.poses[k].index()])});
    robots.push_back({robot.id, Trajectory<SE3>(std::move(poses))});
  }
  return robots;
}

/// Graph of odometry and known starts with white odometry noise only: the published graph has no variable for
/// a constant drift.
JointGraph<SE2> published_odometry(const Mission& mission) {
  Mission white = mission;
  for (Robot& robot : white.robots)
    robot.odometry_noise.sigma_yaw_drift_per_m_rad = robot.odometry_noise.sigma_scale = 0;
  JointGraphParams params;
  params.min_sigma_yaw_drift_per_m_rad = params.min_sigma_scale = 0;
  return build_joint_graph<SE2>(white, {}, params);
}

/// Least squares on the odometry and the pairs below the thresholds.
std::optional<double> estimate_ate_m(const JointGraph<SE2>& odometry, const MeasuredPairs& measured,
                                     const FingerprintCell& cell, const Truth& truth) {
  JointGraph<SE2> joint = odometry;
  add_fingerprint_closures(joint, measured.radio, near_pairs(measured, cell));
  optimize(joint.team.graph, RunParams{}.optimizer);
  return ate_rmse_m(trajectories(joint), truth, kDimension);
}

std::vector<FingerprintCell> published_cells() {
  using namespace published_fingerprint_slam;
  std::vector<FingerprintCell> cells;
  for (std::size_t measure = 0; measure < kFingerprintMeasures.size(); ++measure)
    for (const double nu_within_m : kNu_m) cells.push_back({measure, nu_within_m, 0});
  for (const double nu_within_m : kTeamNuWithin_m)
    for (const std::size_t measure : kTeamMeasures)
      for (const double nu_between_m : kNu_m)
        if (nu_between_m > 0) cells.push_back({measure, nu_within_m, nu_between_m});
  return cells;
}

void add_mission(FingerprintTables& tables, const Mission& mission, const Truth& truth,
                 ProgressCounter& counter) {
  const JointGraph<SE2> odometry = published_odometry(mission);
  std::vector<MeasuredPairs> measured;
  for (const FingerprintMeasure& measure : kFingerprintMeasures)
    measured.push_back(measure_pairs(mission, measure));
  for (FingerprintCell& cell : tables.cells) cell.ate_m.emplace_back();
  parallel_for(tables.cells.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      FingerprintCell& cell = tables.cells[k];
      cell.ate_m.back() = estimate_ate_m(odometry, measured[cell.measure], cell, truth);
      counter.one_more();
    }
  });
  tables.defaults_ate_m.push_back(run_and_evaluate(mission, truth, {}, {}).ate_m);
  tables.dead_reckoning_ate_m.push_back(dead_reckoning_ate_m(mission, truth));
}

}  // namespace

std::optional<double> published_algorithm_ate_m(const Mission& mission, const Truth& truth,
                                                const FingerprintCell& cell) {
  RADIOSLAM_CHECK(mission.dimension == kDimension, "the published algorithm estimates in the plane");
  return estimate_ate_m(published_odometry(mission),
                        measure_pairs(mission, kFingerprintMeasures[cell.measure]), cell, truth);
}

std::optional<double> published_ate_m(std::size_t test, const FingerprintCell& cell) {
  using namespace published_fingerprint_slam;
  RADIOSLAM_CHECK(test < kTests, "there are two tests");
  const auto alone = node_position(cell.nu_within_m, kNu_m),
             between = node_position(cell.nu_between_m, kNu_m);
  if (alone && cell.nu_between_m == 0) return kAlone_m[test][cell.measure][*alone];
  const auto row = node_position(cell.nu_within_m, kTeamNuWithin_m),
             measure = node_position(cell.measure, kTeamMeasures);
  if (!row || !measure || !between) return std::nullopt;
  return kTeam_m[test][*row][*measure][*between];
}

FingerprintTables measure_fingerprint_tables(const CarparkParams& carpark, std::uint64_t first_seed,
                                             int seeds, const Progress& progress) {
  RADIOSLAM_CHECK(carpark.known_start, "the tables need known starts");
  FingerprintTables tables{first_seed, published_cells(), {}, {}};
  ProgressCounter counter(progress, "cells", tables.cells.size() * static_cast<std::size_t>(seeds));
  for (int k = 0; k < seeds; ++k) {
    const auto [mission, truth] = simulate_carpark(carpark, first_seed + static_cast<std::uint64_t>(k));
    add_mission(tables, mission, truth, counter);
  }
  return tables;
}

}  // namespace radioslam

#include "radioslam/study/fingerprints/fingerprint_tables.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/progress_counter.hpp"

namespace radioslam {
namespace {

// Published results of Liu et al., Collaborative Radio SLAM for Multiple Robots based on WiFi Fingerprint
// Similarity, tables I to III: trajectory errors in metres of two drives through a car park ("Test I", "Test
// II"). Table I, for single robots, is the column nu_p = 0 of tables II (Test I) and III (Test II).

constexpr std::size_t kTests = 2;
constexpr std::array kNu_m{0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0};
/// nu_s of the rows of tables II and III.
constexpr std::array kTeamNuWithin_m{0.0, 5.0, 10.0, 20.0, 30.0, 40.0};

/// By test and measure (cosine, Gaussian, sigma_tau = 1, 4, 8), over nu_s.
constexpr double kAlone_m[kTests][5][kNu_m.size()]{
    {{19.251, 4.876, 4.723, 4.746, 4.786, 4.691, 4.782, 4.752, 4.563},
     {19.251, 4.573, 4.375, 4.234, 4.062, 3.943, 3.656, 3.849, 9.346},
     {19.251, 4.754, 4.337, 4.371, 4.370, 4.370, 4.370, 4.370, 4.543},
     {19.251, 4.503, 4.195, 4.167, 3.995, 3.853, 3.618, 3.261, 3.858},
     {19.251, 4.552, 4.285, 4.199, 4.085, 3.879, 3.623, 3.665, 5.766}},
    {{10.124, 9.137, 4.920, 4.172, 3.838, 3.989, 6.124, 8.788, 12.016},
     {10.124, 5.916, 4.181, 3.661, 3.951, 7.074, 11.97, 18.939, 24.913},
     {10.124, 4.816, 4.121, 4.138, 4.138, 4.138, 4.138, 4.339, 4.339},
     {10.124, 5.487, 4.040, 3.672, 3.364, 5.789, 9.104, 11.556, 14.133},
     {10.124, 5.775, 4.141, 3.729, 3.571, 6.199, 11.1604, 18.267, 21.301}}};

/// By test, nu_s of the row and measure (cosine, Gaussian, sigma_tau = 4), over nu_p.
constexpr double kTeam_m[kTests][kTeamNuWithin_m.size()][3][kNu_m.size()]{
    {{{19.251, 17.607, 5.797, 5.142, 4.245, 4.073, 3.659, 3.975, 4.615},
      {19.251, 6.385, 4.626, 3.590, 3.356, 3.087, 3.974, 8.624, 18.928},
      {19.251, 6.718, 4.290, 3.429, 3.201, 2.711, 2.715, 4.931, 7.141}},
     {{4.876, 5.183, 4.199, 4.196, 4.089, 3.974, 3.773, 3.924, 4.625},
      {4.573, 3.893, 3.729, 3.943, 3.603, 3.166, 3.900, 8.522, 18.745},
      {4.503, 4.004, 3.450, 3.426, 3.209, 2.771, 2.787, 4.646, 6.804}},
     {{4.723, 4.610, 4.381, 4.287, 4.206, 4.063, 3.789, 3.938, 4.638},
      {4.375, 4.013, 3.724, 3.702, 3.445, 3.208, 3.943, 8.346, 18.683},
      {4.195, 3.934, 3.462, 3.387, 3.174, 2.847, 2.774, 4.576, 6.716}},
     {{4.786, 4.648, 4.530, 4.369, 4.231, 4.051, 3.883, 4.081, 4.903},
      {4.062, 3.513, 3.302, 3.254, 3.096, 3.286, 4.600, 8.713, 18.491},
      {3.995, 3.557, 3.017, 3.080, 2.844, 2.736, 2.928, 4.821, 6.743}},
     {{4.782, 4.729, 4.192, 3.939, 3.918, 3.892, 4.046, 4.724, 5.591},
      {3.656, 3.215, 3.424, 3.902, 4.271, 4.867, 6.272, 9.882, 18.818},
      {3.618, 2.741, 2.358, 2.689, 3.121, 3.854, 4.267, 6.123, 7.893}},
     {{4.563, 4.189, 3.979, 4.208, 4.359, 4.687, 5.083, 5.976, 6.598},
      {9.346, 11.662, 14.251, 14.737, 14.900, 15.141, 15.687, 17.100, 21.545},
      {3.858, 4.667, 5.345, 5.828, 6.190, 6.763, 7.128, 8.673, 9.971}}},
    {{{10.124, 9.224, 5.426, 5.297, 5.07, 4.124, 4.381, 4.608, 5.465},
      {10.124, 7.690, 4.591, 4.182, 4.044, 4.341, 6.262, 11.536, 22.994},
      {10.124, 6.009, 4.171, 4.1322, 3.910, 4.366, 4.914, 7.746, 10.166}},
     {{9.137, 8.760, 5.492, 4.764, 3.962, 4.032, 4.297, 4.530, 5.395},
      {5.916, 5.384, 4.138, 3.355, 3.289, 3.707, 5.454, 10.757, 22.632},
      {5.487, 4.729, 4.407, 3.882, 3.377, 3.682, 4.114, 6.835, 9.541}},
     {{4.920, 4.727, 4.348, 3.774, 3.576, 3.803, 4.138, 4.374, 5.176},
      {4.181, 3.903, 3.483, 3.185, 3.261, 3.476, 5.025, 9.867, 21.229},
      {4.040, 3.959, 3.183, 3.259, 3.256, 3.512, 3.905, 6.289, 8.640}},
     {{3.838, 3.566, 3.548, 3.519, 3.552, 4.170, 4.490, 4.859, 5.651},
      {3.951, 3.248, 3.259, 3.635, 3.896, 4.481, 6.143, 10.511, 21.661},
      {3.364, 3.3033, 2.736, 3.285, 3.586, 4.105, 4.585, 7.000, 9.267}},
     {{6.124, 5.566, 4.757, 4.885, 4.985, 5.065, 5.365, 5.861, 6.622},
      {11.97, 9.564, 8.178, 7.944, 8.254, 8.855, 10.246, 13.630, 22.577},
      {9.104, 7.547, 6.592, 6.146, 6.411, 6.962, 7.459, 9.464, 11.218}},
     {{12.016, 11.151, 9.615, 9.207, 9.202, 9.258, 9.360, 9.542, 10.065},
      {24.913, 22.916, 20.832, 20.599, 20.721, 20.927, 21.365, 22.480, 26.288},
      {14.133, 12.423, 10.852, 10.481, 10.609, 11.064, 11.355, 12.626, 13.910}}}};

constexpr int kDimension = 2;
constexpr std::array<std::size_t, 3> kTeamMeasures{0, 1, 3};  // those of tables II and III

bool is_of_teams(std::size_t measure) {
  return measure >= kPublishedMeasures ||
         std::find(kTeamMeasures.begin(), kTeamMeasures.end(), measure) != kTeamMeasures.end();
}

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

std::vector<FingerprintCell> cells_of(const std::vector<std::size_t>& measures) {
  std::vector<FingerprintCell> cells;
  for (const std::size_t measure : measures)
    for (const double nu_within_m : kNu_m) cells.push_back({measure, nu_within_m, 0});
  for (const double nu_within_m : kTeamNuWithin_m)
    for (const std::size_t measure : measures)
      for (const double nu_between_m : kNu_m)
        if (nu_between_m > 0 && is_of_teams(measure)) cells.push_back({measure, nu_within_m, nu_between_m});
  return cells;
}

void add_mission(FingerprintTables& tables, const std::vector<std::size_t>& measures, const Mission& mission,
                 const Truth& truth, ProgressCounter& counter) {
  const JointGraph<SE2> odometry = published_odometry(mission);
  for (FingerprintCell& cell : tables.cells) cell.ate_m.emplace_back();
  for (const std::size_t measure : measures) {
    const MeasuredPairs measured = measure_pairs(mission, kFingerprintMeasures[measure]);
    parallel_for(tables.cells.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        FingerprintCell& cell = tables.cells[k];
        if (cell.measure != measure) continue;
        cell.ate_m.back() = estimate_ate_m(odometry, measured, cell, truth);
        counter.one_more();
      }
    });
  }
  tables.defaults_ate_m.push_back(run_and_evaluate(mission, truth, {}, {}).ate_m);
  tables.dead_reckoning_ate_m.push_back(dead_reckoning_ate_m(mission, truth));
}

constexpr int kErrorDecimals = 2, kRatioDecimals = 3;

std::string label_of(const FingerprintCell& cell) {
  const std::string measure = kFingerprintMeasures[cell.measure].label;
  const std::string nu_within = "ν_s " + number_text(cell.nu_within_m, 0);
  if (cell.nu_between_m == 0) return "I: " + measure + ", " + nu_within;
  return "II, III: " + nu_within + ", " + measure + ", ν_p " + number_text(cell.nu_between_m, 0);
}

std::optional<double> over(std::optional<double> part, std::optional<double> whole) {
  if (!part || !whole || *whole <= 0) return std::nullopt;
  return *part / *whole;
}

StudyRow row_of(std::string label, std::optional<double> first_m, std::optional<double> second_m,
                std::optional<double> ours_m, const FingerprintTables& tables) {
  return {std::move(label),
          {number_text(first_m, kErrorDecimals), number_text(second_m, kErrorDecimals),
           number_text(ours_m, kErrorDecimals),
           number_text(over(ours_m, mean_of(tables.dead_reckoning_ate_m)), kRatioDecimals)}};
}

std::string lead_of(const FingerprintTables& tables) {
  const bool simulated = !tables.missions.empty() && tables.missions.front().seed;
  return listed(tables.missions) + ": the published algorithm " +
         (simulated ? "in simulated car parks, " : "") +
         "over its thresholds in metres. Position errors in metres, RMSE after one alignment of the team, " +
         "means over the " + (simulated ? "seeds." : "missions.");
}

std::vector<std::string> fingerprint_notes() {
  return {
      "I: single robots (nu_p = 0); II, III: the team. Table II of the paper is Test I, III is Test II.",
      ("The published drives and odometry are others: compare how the error falls and "
       "rises again with nu, not the metres."),
      ("As published: windows of 5 s, every pair with its full weight 1 / sigma(s)^2, least squares, no "
       "variable for the odometry's constant drift. Chosen here, as not published: odometry's white noise "
       "as the mission states it, 30 samples at least in a window over similarity, sigma of at least 1 m."),
      "The defaults are those of `radioslam run`, the same for every mission."};
}

}  // namespace

std::optional<double> published_algorithm_ate_m(const Mission& mission, const Truth& truth,
                                                const FingerprintCell& cell) {
  RADIOSLAM_CHECK(mission.dimension == kDimension, "the published algorithm estimates in the plane");
  return estimate_ate_m(published_odometry(mission),
                        measure_pairs(mission, kFingerprintMeasures[cell.measure]), cell, truth);
}

std::optional<double> published_ate_m(std::size_t test, const FingerprintCell& cell) {
  RADIOSLAM_CHECK(test < kTests, "there are two tests");
  const auto alone = node_position(cell.nu_within_m, kNu_m),
             between = node_position(cell.nu_between_m, kNu_m);
  if (cell.measure >= kPublishedMeasures) return std::nullopt;
  if (alone && cell.nu_between_m == 0) return kAlone_m[test][cell.measure][*alone];
  const auto row = node_position(cell.nu_within_m, kTeamNuWithin_m),
             measure = node_position(cell.measure, kTeamMeasures);
  if (!row || !measure || !between) return std::nullopt;
  return kTeam_m[test][*row][*measure][*between];
}

std::vector<std::size_t> fingerprint_measures(const std::string& name) {
  std::vector<std::size_t> measures;
  for (std::size_t k = 0; k < kFingerprintMeasures.size(); ++k)
    if (name == "all" || name == kFingerprintMeasures[k].measure || (name.empty() && k < kPublishedMeasures))
      measures.push_back(k);
  return measures;
}

FingerprintTables measure_fingerprint_tables(const std::vector<StudyMission>& missions,
                                             const std::vector<std::size_t>& measures,
                                             const Progress& progress) {
  FingerprintTables tables{{}, cells_of(measures), {}, {}};
  ProgressCounter counter(progress, "cells", tables.cells.size() * missions.size());
  for (const StudyMission& of : missions) {
    RADIOSLAM_CHECK(of_unknown_start(of.mission).empty(), "the tables need known starts");
    tables.missions.push_back({{}, {}, of.seed, of.starts_of_truth});
    tables.missions.back().mission.name = of.mission.name;
    add_mission(tables, measures, of.mission, of.truth, counter);
  }
  return tables;
}

std::optional<double> mean_of(const std::vector<std::optional<double>>& values) {
  double sum = 0, count = 0;
  for (const auto& value : values)
    if (value) sum += *value, ++count;
  if (count == 0) return std::nullopt;
  return sum / count;
}

StudyTable fingerprint_tables_table(const FingerprintTables& tables) {
  const auto published = [](std::size_t test) { return published_ate_m(test, {0, 0, 0}); };
  StudyTable table{"Collaborative radio SLAM by fingerprints",
                   lead_of(tables),
                   {"Test I, published", "Test II, published", "ours", "ours / dead reckoning"},
                   {},
                   fingerprint_notes()};
  std::size_t starts_of_truth = 0;
  for (const StudyMission& mission : tables.missions) starts_of_truth += mission.starts_of_truth;
  if (starts_of_truth > 0)
    table.notes.push_back(
        "The algorithm needs known starts: " + std::to_string(starts_of_truth) +
        " that the missions do not state are those with which odometry fits the truth best.");
  table.rows.push_back(row_of("without ν: the defaults", {}, {}, mean_of(tables.defaults_ate_m), tables));
  table.rows.push_back(
      row_of("dead reckoning", published(0), published(1), mean_of(tables.dead_reckoning_ate_m), tables));
  for (const FingerprintCell& cell : tables.cells)
    table.rows.push_back(row_of(label_of(cell), published_ate_m(0, cell), published_ate_m(1, cell),
                                mean_of(cell.ate_m), tables));
  return table;
}

}  // namespace radioslam

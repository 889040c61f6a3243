#include "report/sample_run.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam::sample {
namespace {

constexpr double kStep_m = 1.0;
constexpr double kSpeed_mps = 1.2;

using Poses = std::vector<StampedPose<SE3>>;

Stamp stamp_of(int robot, int keyframe) {
  return Stamp::from_seconds(1000.0 + 7.0 * robot + keyframe * kStep_m / kSpeed_mps);
}

/// Laps around a rectangle with wandering heading.
Poses walk(int robot, const SampleParams& params, Rng rng) {
  Poses poses;
  SE2 pose(Eigen::Vector2d(6.0 * (robot % 9), 8.0 * (robot / 9)), 0.5 * robot);
  int left_on_side = 20;
  for (int k = 0; k < params.keyframes; ++k) {
    const double height_m = params.dimension == 3 ? 3 * std::sin(0.02 * k) : 0;
    poses.push_back({stamp_of(robot, k), lift(pose, height_m)});
    double turn_rad = rng.normal(0, 0.03);
    if (--left_on_side == 0) {
      turn_rad += rng.uniform() < 0.8 ? M_PI / 2 : -M_PI / 2;
      left_on_side = 10 + static_cast<int>(rng.below(35));
    }
    pose = pose * SE2::exp({kStep_m, 0, turn_rad});
  }
  return poses;
}

/// The same steps measured by sensors: a constant heading drift per metre, and noise.
Poses drifted(const Poses& truth, double drift_rad, double sigma, const SE3& T_frame_truth, Rng rng) {
  Poses poses{{truth.front().stamp, T_frame_truth * truth.front().pose}};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    SE3::Tangent step = (truth[k - 1].pose.inverse() * truth[k].pose).log();
    step[0] += rng.normal(0, sigma);
    step[5] += drift_rad + rng.normal(0, sigma / 10);
    poses.push_back({truth[k].stamp, poses.back().pose * SE3::exp(step)});
  }
  return poses;
}

/// Close to the truth, with a slowly varying error.
Poses near_truth(const Poses& truth, const SE3& T_frame_truth, Rng rng) {
  Poses poses;
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  for (const auto& [stamp, pose] : truth) {
    const double east_m = rng.normal(0, 0.15), north_m = rng.normal(0, 0.15);
    error = 0.97 * error + Eigen::Vector2d(east_m, north_m);
    const SE3 off(pose.translation() + Eigen::Vector3d(error.x(), error.y(), 0), pose.rotation());
    poses.push_back({stamp, T_frame_truth * off});
  }
  return poses;
}

void add_robot(Sample& sample, int r, const SampleParams& params, const Rng& rng) {
  const SE3 T_frame_truth = lift(SE2(Eigen::Vector2d(-3, 5), 0.7));
  const std::string id =
      params.robots <= 26 ? std::string(1, static_cast<char>('a' + r)) : "r" + std::to_string(r);
  const auto index = static_cast<std::uint64_t>(r);
  const Poses truth = walk(r, params, rng.split("walk").split(index));
  Rng drift = rng.split("drift").split(index);
  RobotResult robot;
  robot.start_known = true;
  robot.id = id;
  robot.yaw_drift_per_m_rad = drift.normal(0, 0.0006);
  robot.scale_error = drift.normal(0, 0.02);
  robot.estimate = Trajectory<SE3>(near_truth(truth, T_frame_truth, rng.split("estimate").split(index)));
  robot.odometry = Trajectory<SE3>(
      drifted(truth, robot.yaw_drift_per_m_rad, 0.03, T_frame_truth, rng.split("odometry").split(index)));
  for (int k = 0; k < params.keyframes; ++k) {
    robot.sigma_position_m.push_back(0.5 + 0.3 * std::sin(0.05 * k));
    robot.sigma_team_m.push_back(0.5 * robot.sigma_position_m.back());
  }
  sample.result.robots.push_back(std::move(robot));
  sample.truth.robots.push_back({id, Trajectory<SE3>(truth), true});
}

ClosureResult random_closure(const SampleParams& params, Rng& rng) {
  const auto pick = [&](int count) { return static_cast<int>(rng.below(static_cast<std::uint64_t>(count))); };
  ClosureResult closure;
  const int i = pick(params.robots), j = pick(params.robots);
  closure.robot_i = RobotIndex(i);
  closure.robot_j = RobotIndex(j);
  closure.stamp_i = stamp_of(i, pick(params.keyframes));
  closure.stamp_j = stamp_of(j, pick(params.keyframes));
  closure.kind = rng.uniform() < 0.8 ? ClosureKind::kFingerprint : ClosureKind::kRange;
  closure.statistic = rng.uniform(0, 20);
  return closure;
}

/// Close pairs are accepted, most of the others are not proposed at all.
void add_closures(Sample& sample, const SampleParams& params, Rng rng) {
  const auto wanted = static_cast<std::size_t>(params.closures);
  const auto position = [&](RobotIndex robot, Stamp stamp) {
    return sample.truth.robots[robot.index()].poses.at(stamp)->translation();
  };
  while (sample.result.closures.size() < wanted) {
    ClosureResult closure = random_closure(params, rng);
    const double distance_m =
        (position(closure.robot_i, closure.stamp_i) - position(closure.robot_j, closure.stamp_j)).norm();
    if (distance_m > 12 && rng.uniform() > 0.01) continue;
    if (distance_m > 12 || rng.uniform() < 0.1) {
      closure.status = ClosureStatus::kRejected;
      closure.reason = distance_m > 12 ? "residual beyond the gate" : "too few access points in common";
    }
    sample.result.closures.push_back(closure);
  }
}

/// Close pairs of different robots, the one listed first in front; some may occur twice.
void add_candidates(Sample& sample, const SampleParams& params, Rng rng) {
  const auto wanted = static_cast<std::size_t>(params.candidates);
  while (sample.result.candidates.size() < wanted) {
    const ClosureResult drawn = random_closure(params, rng);
    if (drawn.robot_i.value >= drawn.robot_j.value) continue;
    const auto position = [&](RobotIndex robot, Stamp stamp) {
      return sample.truth.robots[robot.index()].poses.at(stamp)->translation();
    };
    const double distance_m =
        (position(drawn.robot_i, drawn.stamp_i) - position(drawn.robot_j, drawn.stamp_j)).norm();
    if (distance_m > 30) continue;
    sample.result.candidates.push_back(
        {drawn.robot_i, drawn.stamp_i, drawn.robot_j, drawn.stamp_j, static_cast<float>(distance_m), 0.5F});
  }
  if (wanted == 0) return;
  const double robots = params.robots, keyframes = params.keyframes;
  sample.result.counts["pairs"] = robots * (robots - 1) / 2 * keyframes * keyframes;
  sample.result.counts["candidates"] = params.candidates;
  sample.result.counts["distances_evaluated"] = 1.25 * params.candidates;
}

/// The team with all robots but the first rotated about their starts, further for each alternative.
void add_alternatives(RunResult& result, int count) {
  for (int k = 1; k <= count; ++k) {
    HypothesisResult other{0.3 / k, result.robots};
    for (std::size_t r = 1; r < other.robots.size(); ++r) {
      RobotResult& robot = other.robots[r];
      const SE3 start = robot.estimate.front().pose;
      const SE3 turn = start * lift(SE2(Eigen::Vector2d(4 * k, 0), 0.8 * k)) * start.inverse();
      Poses poses(robot.estimate.begin(), robot.estimate.end());
      for (auto& [stamp, pose] : poses) pose = turn * pose;
      robot.estimate = Trajectory<SE3>(std::move(poses));
    }
    result.alternatives.push_back(std::move(other));
  }
  if (count > 0) result.weight = 0.6;
}

void add_similarity(RunResult& result, Rng rng) {
  SimilarityModelResult model;
  model.measure = "gaussian";
  const auto mean = [](double similarity) { return 38 * std::exp(-3 * similarity) + 2; };
  for (int i = 0; i < 3000; ++i) {
    const double similarity = std::pow(rng.uniform(), 1.6);
    model.samples.emplace_back(similarity, std::abs(mean(similarity) * (1 + 0.35 * rng.normal())));
  }
  for (int b = 1; b < 19; ++b)
    model.bins.push_back({0.05 * b, mean(0.05 * b), 0.35 * mean(0.05 * b), 300 - 12 * b});
  result.similarity_model = std::move(model);
}

double turned_to(double a_rad, double b_rad) { return std::remainder(a_rad - b_rad, 2 * M_PI); }

/// Lobes around peaks, the direct one first, and a cross term between two of them.
MeasuredAoaResult aoa_around(double true_azimuth_rad, Rng rng) {
  constexpr int kValues = 360;
  MeasuredAoaResult aoa;
  const double second_rad = true_azimuth_rad + rng.uniform(0.6, 2.4), weaker_db = -rng.uniform(1, 6);
  const double near_rad = rng.normal(true_azimuth_rad, 0.04);
  const double cross_term_rad = near_rad + turned_to(second_rad, near_rad) / 2;
  const auto wrapped = [](double angle_rad) { return std::remainder(angle_rad, 2 * M_PI); };
  aoa.peaks = {{wrapped(near_rad), 0.05, 0, false},
               {wrapped(second_rad), 0.09, weaker_db, false},
               {wrapped(cross_term_rad), 0.16, weaker_db - 3, true}};
  for (int k = 0; k < kValues; ++k) {
    const double azimuth_rad = -M_PI + 2 * M_PI * k / kValues;
    double power = 0.03 + 0.02 * std::cos(9 * azimuth_rad);
    for (const auto& peak : aoa.peaks) {
      const double away = turned_to(azimuth_rad, peak.azimuth_rad) / 0.13;
      power = std::max(power, std::pow(10, peak.power_db / 10) * std::exp(-away * away / 2));
    }
    aoa.profile.push_back(static_cast<float>(power));
  }
  aoa.estimated_azimuth_rad = wrapped(rng.normal(true_azimuth_rad, 0.03));
  return aoa;
}

/// Every robot in turn receives one of the others.
void add_aoa_measurements(Sample& sample, const SampleParams& params, const Rng& rng) {
  for (int k = 0; k < params.aoa_measurements; ++k) {
    const int receiver = k % params.robots,
              transmitter = (receiver + 1 + (k / params.robots) % 2) % params.robots;
    const auto& here = sample.truth.robots[static_cast<std::size_t>(receiver)];
    const auto& there = sample.truth.robots[static_cast<std::size_t>(transmitter)];
    const Stamp stamp = stamp_of(receiver, 20 + (37 * k) % (params.keyframes - 40));
    const Eigen::Vector3d seen = here.poses.at(stamp)->inverse() * there.poses.at(stamp)->translation();
    auto aoa = aoa_around(std::atan2(seen.y(), seen.x()), rng.split(static_cast<std::uint64_t>(k)));
    aoa.receiver = here.id;
    aoa.transmitter = there.id;
    aoa.stamp = stamp;
    sample.result.aoa_measurements.push_back(std::move(aoa));
  }
}

void add_run(RunResult& result) {
  result.timings = {{"read", 0.041},    {"fingerprints", 0.212}, {"similarity", 1.35}, {"team frame", 0.48},
                    {"closures", 0.88}, {"optimise", 0.61},      {"marginals", 0.093}, {"report", 0.0042}};
  result.parameters = {
      {"keyframe.distance_m", "1", "m", "a keyframe at least every so many metres", false},
      {"keyframe.angle_rad", "0.174533", "rad", "a keyframe at least every such turn", false},
      {"fingerprint.window_s", "8", "s", "length of a fingerprint's window", true},
      {"similarity.measure", "gaussian", "", "how two fingerprints are compared", false},
      {"similarity.sigma_rss_db", "6", "dB", "spread of the signal strength at one place", false},
      {"closure.maximum_distance_m", "12", "m", "closures whose predicted distance is longer are not used",
       true},
      {"optimizer.loss", "cauchy", "", "robust loss of closures", false}};
  result.counts = {
      {"fingerprints", 412}, {"access_points", 71}, {"pairs_compared", 84666}, {"factors", 2399}};
}

}  // namespace

Sample make_sample(const SampleParams& params) {
  const Rng rng(5);
  Sample sample;
  RunResult& result = sample.result;
  result.mission_name = "carpark-" + std::to_string(params.robots);
  result.dimension = params.dimension;
  result.components.emplace_back();
  for (int r = 0; r < params.robots; ++r) {
    add_robot(sample, r, params, rng);
    result.components.front().robots.push_back(result.robots.back().id);
  }
  add_closures(sample, params, rng.split("closures"));
  add_similarity(result, rng.split("similarity"));
  add_run(result);
  add_candidates(sample, params, rng.split("candidates"));
  add_alternatives(result, params.alternatives);
  add_aoa_measurements(sample, params, rng.split("aoa_measurements"));
  std::vector<EstimatedTrajectory> estimate;
  for (const auto& robot : result.robots) estimate.push_back({robot.id, robot.estimate});
  sample.metrics = evaluate_trajectories(estimate, sample.truth, params.dimension);
  return sample;
}

}  // namespace radioslam::sample

// The mixtures are normalised densities, and their weights are posteriors.
#include "radioslam/team_frame/measurement_mixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kDistance_m = 10;  ///< to the transmitter

BearingPath<SE2> path(double azimuth_rad, double sigma_rad, double power_db) {
  return {{std::cos(azimuth_rad), std::sin(azimuth_rad)}, sigma_rad, power_db};
}
BearingPath<SE3> path(const Eigen::Vector3d& direction, double sigma_rad, double power_db) {
  return {direction.normalized(), sigma_rad, power_db};
}

/// A receiver and a transmitter at a distance, observed along these paths; no odometry.
template <class Pose>
TeamGraph<Pose> received_by(const std::vector<BearingPath<Pose>>& paths) {
  TeamGraph<Pose> team;
  team.graph.poses.resize(2);
  team.segments = {{"a", 0, 1, {Stamp{}}}, {"b", 1, 1, {Stamp{}}}};
  AmbiguousBearing<Pose> bearing;
  bearing.i = PoseId(0);
  bearing.j.pose = PoseId(1);
  bearing.paths = paths;
  team.bearings.push_back(bearing);
  return team;
}

TeamGraph<SE2> three_paths() {
  return received_by<SE2>({path(0.3, 0.1, -50), path(-2, 0.2, -55), path(2.5, 0.15, -60)});
}

void put_transmitter(MixtureGraph<SE2>& mixture, double azimuth_rad) {
  mixture.graph.poses[1] =
      SE2(kDistance_m * Eigen::Vector2d(std::cos(azimuth_rad), std::sin(azimuth_rad)), 0);
}

/// Likelihood at the current values: a density relative to the uniform one.
template <class Pose>
double likelihood(const MixtureGraph<Pose>& mixture) {
  return std::exp(-mixture.cost({}, 0) / 2);
}

TEST(MeasurementMixture, AnAnglesDensityIntegratesToOneOverTheCircle) {
  MixtureGraph<SE2> mixture(three_paths(), {});
  constexpr int kSteps = 720;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    put_transmitter(mixture, 2 * std::numbers::pi * k / kSteps);
    sum += likelihood(mixture);
  }
  // The chord's normal density differs from von Mises by a relative sigma^2 / 8 in its constant.
  EXPECT_NEAR(sum / kSteps, 1, 0.2 * 0.2 / 8);
}

TEST(MeasurementMixture, ADirectionsDensityIntegratesToOneOverTheSphere) {
  MixtureGraph<SE3> mixture(received_by<SE3>({path({1, 1, 0.5}, 0.2, -50), path({-1, 0.2, -0.3}, 0.3, -52)}),
                            {});
  constexpr int kRings = 80, kSteps = 160;
  double sum = 0;
  for (int r = 0; r < kRings; ++r)  // rings of equal area
    for (int k = 0; k < kSteps; ++k) {
      const double z = 2 * (r + 0.5) / kRings - 1, level = std::sqrt(1 - z * z);
      const double azimuth = 2 * std::numbers::pi * k / kSteps;
      mixture.graph.poses[1] =
          SE3(10 * Eigen::Vector3d(level * std::cos(azimuth), level * std::sin(azimuth), z),
              Eigen::Quaterniond::Identity());
      sum += likelihood(mixture);
    }
  EXPECT_NEAR(sum / (kRings * kSteps), 1, 1e-3);
}

TEST(MeasurementMixture, AnAzimuthInSpaceHasTheDensityOfTheCircleAtAnyElevation) {
  auto flat = path({1, 1, 0}, 0.2, -50);
  flat.azimuth_only = true;
  MixtureGraph<SE3> mixture(received_by<SE3>({flat}), {});
  for (const double z_m : {-20.0, 0.0, 5.0}) {
    constexpr int kSteps = 720;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / kSteps;
      mixture.graph.poses[1] =
          SE3({10 * std::cos(azimuth), 10 * std::sin(azimuth), z_m}, Eigen::Quaterniond::Identity());
      sum += likelihood(mixture);
    }
    EXPECT_NEAR(sum / kSteps, 1, 0.2 * 0.2 / 8);
  }
}

RangeFactor<SE2> range_of(double range_m) {
  RangeFactor<SE2> range;
  range.i.pose = PoseId(0);
  range.j.pose = PoseId(1);
  range.range_m = range_m;
  range.sigma_m = 0.5;
  return range;
}

MixtureParams all_in_sight() {
  MixtureParams params;
  params.obstructed_share = 0;
  return params;
}

/// Two poses `distance_m` apart with one range, and another pair with the longest range of the team, 100 m.
MixtureGraph<SE2> ranged(double distance_m, double range_m, const MixtureParams& params) {
  TeamGraph<SE2> team;
  team.graph.poses = {SE2(), SE2({distance_m, 0}, 0), SE2(), SE2({100, 0}, 0)};
  team.segments = {
      {"a", 0, 1, {Stamp{}}}, {"b", 1, 1, {Stamp{}}}, {"c", 2, 1, {Stamp{}}}, {"d", 3, 1, {Stamp{}}}};
  team.graph.ranges = {range_of(range_m), range_of(100)};
  team.graph.ranges[1].i.pose = PoseId(2);
  team.graph.ranges[1].j.pose = PoseId(3);
  return {team, params};
}

TEST(MeasurementMixture, ARangesDensityIntegratesToOneOverTheSpan) {
  const double e = MixtureParams{}.false_range_probability;
  const double of_the_longest = (1 - e) / (std::sqrt(2 * std::numbers::pi) * 0.5) + e / 100;
  constexpr double kStep_m = 0.05;
  double sum = 0;
  for (int k = 0; k < 2000; ++k)
    sum += kStep_m * likelihood(ranged(40, kStep_m * (k + 0.5), all_in_sight())) / of_the_longest;
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(MeasurementMixture, ARangesWeightIsThePosteriorOfBeingDirect) {
  MixtureParams params = all_in_sight();
  params.false_range_probability = 0.1;
  auto near = ranged(40, 40.5, params), far = ranged(40, 45, params);
  near.update_weights({}, 0);
  far.update_weights({}, 0);
  const double direct = 0.9 * std::exp(-0.5) / (std::sqrt(2 * std::numbers::pi) * 0.5);
  EXPECT_NEAR(near.graph.ranges[0].weight, direct / (direct + 0.1 / 100), 1e-12);
  EXPECT_LT(far.graph.ranges[0].weight, 1e-10);
}

TEST(MeasurementMixture, WeightsAndTheNullSumToOne) {
  MixtureParams params = all_in_sight();
  params.direct_probability = 0.7;
  MixtureGraph<SE2> mixture(three_paths(), params);
  for (const double azimuth : {0.3, 0.6, -1.7, 1.0}) {
    put_transmitter(mixture, azimuth);
    mixture.update_weights({}, 0);
    const double null = (1 - params.direct_probability) / likelihood(mixture);
    EXPECT_NEAR(mixture.direct_weight(0) + null, 1, 1e-12) << azimuth;
    EXPECT_GT(null, 0);
  }
}

/// Bayes by hand: no path, or one of three with its prior and the density of its chord.
TEST(MeasurementMixture, PathWeightsArePosteriors) {
  const auto team = three_paths();
  const MixtureParams params = all_in_sight();
  MixtureGraph<SE2> mixture(team, params);
  const double azimuth = 0.45;
  put_transmitter(mixture, azimuth);
  mixture.update_weights({}, 0);
  const auto priors = path_priors(team.bearings[0], params);
  const double place = params.sigma_antenna_position_m / kDistance_m;
  const double azimuths[] = {0.3, -2, 2.5};
  const double sigmas[] = {std::hypot(0.1, place), std::hypot(0.2, place), std::hypot(0.15, place)};
  std::vector<double> terms;
  for (std::size_t p = 0; p < 3; ++p) {
    const double chord = 2 * std::sin((azimuth - azimuths[p]) / 2) / sigmas[p];
    terms.push_back(params.direct_probability * priors[p] * std::sqrt(2 * std::numbers::pi) / sigmas[p] *
                    std::exp(-chord * chord / 2));
  }
  const double total = 1 - params.direct_probability + terms[0] + terms[1] + terms[2];
  for (std::size_t p = 0; p < 3; ++p)
    EXPECT_NEAR(mixture.graph.bearings[mixture.first_path(0) + p].weight, terms[p] / total, 1e-12);
  EXPECT_GT(terms[0] / total, 0.5);
}

TEST(MeasurementMixture, APathTenDecibelsStrongerIsTwiceAsLikely) {
  const auto priors = path_priors(three_paths().bearings[0], {});
  EXPECT_NEAR(std::accumulate(priors.begin(), priors.end(), 0.0), 1, 1e-12);
  EXPECT_NEAR(priors[0] / priors[2], 2, 1e-12);
  EXPECT_NEAR(priors[0] / priors[1], std::sqrt(2), 1e-12);
}

TEST(MeasurementMixture, ARangeShorterThanTheDistanceIsNoDetour) {
  const auto weight_of = [](double range_m) {
    auto mixture = ranged(40, range_m, {});
    mixture.update_weights({}, 0);
    return mixture.range_weight(0);
  };
  EXPECT_GT(weight_of(40), 0.9);
  EXPECT_LT(weight_of(43), 0.001);
  EXPECT_GT(weight_of(38.4), 2 * weight_of(41.6)) << "longer ranges have one more explanation";
}

TEST(MeasurementMixture, ADetouredRangeMakesTheAnglesOfItsExchangeUnlikely) {
  TeamGraph<SE2> team = received_by<SE2>({path(0, 0.1, -50)});
  const auto angle_weight = [&](double range_m) {
    team.graph.ranges = {range_of(range_m)};
    MixtureGraph<SE2> mixture(team, {});
    put_transmitter(mixture, 0.05);
    mixture.update_weights({}, 0);
    return mixture.direct_weight(0);
  };
  EXPECT_GT(angle_weight(kDistance_m), 0.9);
  EXPECT_LT(angle_weight(kDistance_m + 20), 0.5);
}

/// The weighted factor is a quadratic model of a range's mixture: it has the gradient of the cost.
TEST(MeasurementMixture, TheGradientOfAWeightedRangeIsThatOfTheCost) {
  for (const double range_m : {38.0, 39.7, 40.4, 42.0, 60.0}) {
    auto mixture = ranged(40, range_m, {});
    mixture.update_weights({}, 0);
    const auto gradient = [&](const auto& cost) {
      constexpr double kStep_m = 1e-5;
      const double more = (mixture.graph.poses[1] = SE2({40 + kStep_m, 0}, 0), cost());
      const double less = (mixture.graph.poses[1] = SE2({40 - kStep_m, 0}, 0), cost());
      return (more - less) / (2 * kStep_m);
    };
    const double of_cost = gradient([&] { return mixture.cost({}, 0); });
    const double of_factor = gradient([&] {
      const auto& range = mixture.graph.ranges[0];
      const double error = (mixture.graph.poses[1].translation().norm() - range.range_m) / range.sigma_m;
      return range.weight * error * error;
    });
    EXPECT_NEAR(of_factor, of_cost, 1e-4 * std::max(1.0, std::abs(of_cost))) << range_m;
  }
}

TEST(MeasurementMixture, TheObstructedShareFollowsFromTheMeasurements) {
  TeamGraph<SE2> team;
  constexpr std::size_t kLinks = 100, kObstructed = 70;
  team.segments = {{"a", 0, kLinks, {}}, {"b", kLinks, kLinks, {}}};
  for (std::size_t k = 0; k < 2 * kLinks; ++k)
    team.graph.poses.push_back(SE2({k < kLinks ? 0.0 : 40.0, 0}, 0));
  for (std::size_t k = 0; k < kLinks; ++k) {
    for (TrajectorySegment& segment : team.segments)
      segment.stamps.push_back(Stamp::from_seconds(100.0 * static_cast<double>(k)));
    RangeFactor<SE2> range = range_of(k < kObstructed ? 50.0 + 0.3 * static_cast<double>(k) : 40.0);
    range.i.pose = PoseId(k);
    range.j.pose = PoseId(kLinks + k);
    team.graph.ranges.push_back(range);
  }
  MixtureGraph<SE2> mixture(team, {});
  mixture.estimate_obstructed_share({}, 0);
  EXPECT_NEAR(mixture.obstructed_share(), 0.7, 0.03);
  MixtureGraph<SE2> in_sight(team, all_in_sight());
  in_sight.estimate_obstructed_share({}, 0);
  EXPECT_EQ(in_sight.obstructed_share(), 0);
}

TEST(MeasurementMixture, InflationAddsToEveryVariance) {
  auto team = three_paths();
  team.graph.ranges.push_back(range_of(10));
  MixtureGraph<SE2> mixture(team, {});
  put_transmitter(mixture, 0.3);
  const double place2 = std::pow(MixtureParams{}.sigma_antenna_position_m / kDistance_m, 2);
  mixture.update_weights({{2}, {0.09}}, 0.5);
  EXPECT_NEAR(mixture.graph.ranges[0].sigma_m, std::sqrt(0.25 + 1), 1e-12);
  EXPECT_NEAR(mixture.graph.bearings[0].sigma_rad, std::sqrt(0.01 + 0.045 + place2), 1e-12);
  mixture.update_weights({{2}, {0.09}}, 0);
  EXPECT_NEAR(mixture.graph.ranges[0].sigma_m, 0.5, 1e-12);
  EXPECT_NEAR(mixture.graph.bearings[0].sigma_rad, std::sqrt(0.01 + place2), 1e-12);
}

TEST(MeasurementMixture, AnAngleInflatedBeyondTheCircleSaysNothing) {
  MixtureGraph<SE2> mixture(received_by<SE2>({path(0, 0.1, -50)}), {});
  put_transmitter(mixture, 0);
  EXPECT_NEAR(mixture.cost({{}, {1e6}}, 1), 0, 1e-9) << "the uniform density at the peak";
  put_transmitter(mixture, 3);
  EXPECT_LT(std::abs(mixture.cost({{}, {1e6}}, 1)), 1);
}

TEST(MeasurementMixture, CostIsWhatReweighReturnsAndCountsTheOdometry) {
  auto team = three_paths();
  RelativePoseFactor<SE2> odometry{PoseId(0), PoseId(1), SE2({9, 0}, 0)};
  odometry.information *= 4;
  team.graph.relative_poses.push_back(odometry);
  MixtureGraph<SE2> mixture(team, {});
  mixture.graph.poses[1] = SE2({10, 0}, 0);
  const double with = mixture.cost({}, 0);
  EXPECT_EQ(mixture.update_weights({}, 0), with);
  mixture.graph.relative_poses.clear();
  EXPECT_NEAR(with - mixture.cost({}, 0), 4, 1e-12);
}

TEST(MeasurementMixture, AnAngleFromBeyondTheReachIsUnlikely) {
  TeamGraph<SE2> team = received_by<SE2>({path(0, 0.1, -50)});
  MixtureParams params = all_in_sight();
  params.max_range_m = 80;
  params.sigma_antenna_position_m = 1e-3;  // otherwise the distance matters within the range too
  const auto cost_at = [&](double distance_m) {
    MixtureGraph<SE2> mixture(team, params);
    mixture.graph.poses[1] = SE2({distance_m, 0}, 0);
    return mixture.cost({}, 0);
  };
  EXPECT_NEAR(cost_at(20), cost_at(80), 1e-4);
  EXPECT_NEAR(cost_at(120) - cost_at(80), 4, 1e-4) << "two standard deviations of a quarter of the reach";
  EXPECT_GT(cost_at(2000), 500);
}

TEST(MeasurementMixture, TheLongestRangeIsWithinReach) {
  TeamGraph<SE2> team = received_by<SE2>({path(0, 0.1, -50)});
  MixtureParams params = all_in_sight();
  params.sigma_antenna_position_m = 1e-3;
  params.false_range_probability = 0.5;  // so that the range itself has the same likelihood at both
  RangeFactor<SE2> range;
  range.i.pose = PoseId(0);
  range.j.pose = PoseId(1);
  range.range_m = 5000;
  range.sigma_m = 1;
  team.graph.ranges.push_back(range);
  const auto cost_at = [&](double distance_m) {
    MixtureGraph<SE2> mixture(team, params);
    mixture.graph.poses[1] = SE2({distance_m, 0}, 0);
    return mixture.cost({}, 0);
  };
  EXPECT_NEAR(cost_at(20), cost_at(4900), 1e-4);
  EXPECT_GT(cost_at(20000), cost_at(20) + 100);
}

/// Two robots side by side with more links than one thread computes at a time.
TeamGraph<SE2> team_of_many_links() {
  constexpr std::size_t kPoses = 900;
  Rng rng(8);
  TeamGraph<SE2> team;
  for (std::size_t robot = 0; robot < 2; ++robot) {
    team.segments.push_back({robot == 0 ? "a" : "b", robot * kPoses, kPoses, {}});
    for (std::size_t k = 0; k < kPoses; ++k) {
      team.graph.poses.emplace_back(
          Eigen::Vector2d(static_cast<double>(k), 30 * static_cast<double>(robot) + rng.normal()),
          rng.uniform(-1, 1));
      team.segments.back().stamps.push_back(Stamp::from_seconds(static_cast<double>(k)));
      if (k == 0) continue;
      RelativePoseFactor<SE2> step;
      step.i = PoseId(robot * kPoses + k - 1);
      step.j = PoseId(robot * kPoses + k);
      step.T_i_j = SE2({1, 0}, 0);
      team.graph.relative_poses.push_back(step);
    }
  }
  for (std::size_t k = 0; k < kPoses; ++k) {
    RangeFactor<SE2> range;
    range.i.pose = PoseId(k);
    range.j.pose = PoseId(kPoses + k);
    range.range_m = rng.uniform(20, 60);
    team.graph.ranges.push_back(range);
    AmbiguousBearing<SE2> bearing;
    bearing.i = PoseId(k);
    bearing.j.pose = PoseId(kPoses + k);
    bearing.paths = {path(rng.uniform(0, 3), 0.1, -50), path(rng.uniform(-3, 0), 0.2, -55)};
    team.bearings.push_back(bearing);
  }
  return team;
}

TEST(MeasurementMixture, HasTheSameBytesOnAnyNumberOfThreads) {
  const TeamGraph<SE2> team = team_of_many_links();
  const auto weighed_by = [&](std::size_t threads, double& cost) {
    set_thread_count(threads);
    MixtureGraph<SE2> mixture(team, {});
    mixture.estimate_obstructed_share({}, 0);
    cost = mixture.update_weights({}, 0);
    EXPECT_EQ(mixture.cost({}, 0), cost);
    std::vector<double> weights{mixture.obstructed_share()};
    for (const auto& range : mixture.graph.ranges)
      weights.insert(weights.end(), {range.weight, range.range_m, range.sigma_m});
    for (const auto& bearing : mixture.graph.bearings)
      weights.insert(weights.end(), {bearing.weight, bearing.sigma_rad});
    set_thread_count(0);
    return weights;
  };
  double by_one = 0, by_three = 0;
  EXPECT_EQ(weighed_by(1, by_one), weighed_by(3, by_three));
  EXPECT_EQ(by_one, by_three);
}

}  // namespace
}  // namespace radioslam

#include "radioslam/study/oracle.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/evaluated_run.hpp"
#include "study/small_town.hpp"

namespace radioslam {
namespace {

double oracle_error_m(const CityParams& town, std::uint64_t seed) {
  const auto [mission, truth] = simulate_city(town, seed);
  const auto estimate = oracle_estimate(mission, truth, {});
  EXPECT_TRUE(estimate);
  return *ate_rmse_m(*estimate, truth, mission.dimension);
}

TEST(Oracle, FindsTheTruthWithoutNoise) {
  for (const int dimension : {2, 3}) {
    CityParams town = small_town();
    town.dimension = dimension;
    town.odometry.sigma_xy_per_sqrt_m = town.odometry.sigma_yaw_per_sqrt_m_rad = 1e-5;
    town.odometry.sigma_yaw_per_rad = town.sigma_z_per_sqrt_m = 1e-5;
    town.radio.sigma_range_m = 0.001;
    town.radio.sigma_angle_deg = 0.01;
    EXPECT_LT(oracle_error_m(town, 1), 0.02) << dimension;
  }
}

TEST(Oracle, DoesNotSeeFalsePaths) {
  CityParams town = small_town();
  town.radio.missing_direct_ratio = 0;
  town.radio.max_false_paths = 0;
  const double alone = oracle_error_m(town, 2);
  town.radio.min_false_paths = town.radio.max_false_paths = 8;
  EXPECT_NEAR(oracle_error_m(town, 2), alone, 1e-6);
}

/// The second robot turned by half a turn about a far point.
Trajectory<SE3> misplaced(const Trajectory<SE3>& poses) {
  const SE3 T = lift(SE2({300, -200}, 3.1), 0);
  std::vector<StampedPose<SE3>> moved(poses.begin(), poses.end());
  for (auto& row : moved) row.pose = T * row.pose;
  return Trajectory<SE3>(std::move(moved));
}

std::vector<EstimatedTrajectory> as_start(const Truth& start) {
  std::vector<EstimatedTrajectory> robots;
  for (const RobotTruth& robot : start.robots) robots.push_back({robot.id, robot.poses});
  return robots;
}

TEST(Oracle, DoesNotDependOnTheOrderOfItsStarts) {
  const Simulation town = simulate_city(small_town(), 4);
  const Truth& truth = town.truth;
  Truth misplaced_truth = truth;
  misplaced_truth.robots[1].poses = misplaced(truth.robots[1].poses);
  const auto error_m = [&](const Truth& first, const Truth& second) {
    return *ate_rmse_m(*oracle_estimate(town.mission, first, {}, as_start(second)), truth, 2);
  };
  const double one = error_m(truth, misplaced_truth), other = error_m(misplaced_truth, truth);
  EXPECT_NE(error_m(truth, truth), error_m(misplaced_truth, misplaced_truth)) << "the starts differ";
  EXPECT_DOUBLE_EQ(one, other) << "the likelier result counts";
}

TEST(Oracle, IgnoresAStartThatDoesNotCoverTheOdometry) {
  const auto [mission, truth] = simulate_city(small_town(), 4);
  auto part = as_start(truth);
  part[1].poses = Trajectory<SE3>(
      std::vector<StampedPose<SE3>>(truth.robots[1].poses.begin() + 10, truth.robots[1].poses.end()));
  const auto alone = oracle_estimate(mission, truth, {}),
             with_part = oracle_estimate(mission, truth, {}, part);
  EXPECT_EQ(*ate_rmse_m(*alone, truth, 2), *ate_rmse_m(*with_part, truth, 2));
}

TEST(Oracle, IsHelpedByMoreLinks) {
  CityParams town = small_town();
  town.odometry.sigma_yaw_per_sqrt_m_rad = 0.01;
  double few = 0, many = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    town.radio.links = 3;
    few += oracle_error_m(town, seed);
    town.radio.links = 60;
    many += oracle_error_m(town, seed);
  }
  EXPECT_LT(many, 0.8 * few);
}

TEST(Oracle, KeepsTheLabelledPathsAlone) {
  auto [mission, truth] = simulate_city(small_town(), 3);
  mission.matches.resize(4);
  truth.direct_paths[0] = kNoDirectPath;
  truth.direct_paths[1] = std::nullopt;
  truth.direct_paths[2] = static_cast<int>(mission.aoa_measurements[2].paths.size()) - 1;
  const Mission labelled = with_direct_paths_only(mission, truth);
  EXPECT_TRUE(labelled.matches.empty());
  EXPECT_LE(labelled.aoa_measurements.size(), mission.aoa_measurements.size() - 2);
  ASSERT_FALSE(labelled.aoa_measurements.empty());
  EXPECT_EQ(labelled.aoa_measurements.front().paths.front().azimuth_rad,
            mission.aoa_measurements[2].paths.back().azimuth_rad);
  for (const auto& aoa : labelled.aoa_measurements) EXPECT_EQ(aoa.paths.size(), 1U);
}

TEST(Oracle, NeedsATruthToStartFrom) {
  const auto [mission, truth] = simulate_city(small_town(), 4);
  Truth waypoints = truth;
  waypoints.robots[0].has_orientation = false;
  EXPECT_FALSE(oracle_estimate(mission, waypoints, {}));
  Truth late = truth;
  std::vector<StampedPose<SE3>> poses(truth.robots[1].poses.begin() + 5, truth.robots[1].poses.end());
  late.robots[1].poses = Trajectory<SE3>(std::move(poses));
  EXPECT_FALSE(oracle_estimate(mission, late, {}));
  Mission anchored = mission;
  anchored.anchors.push_back({"x", std::nullopt, 0});
  EXPECT_FALSE(oracle_estimate(anchored, truth, {}));
}

}  // namespace
}  // namespace radioslam

#include "radioslam/pipeline/pipeline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/small_carpark.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {
namespace {

/// A small floor that two robots cover completely.
CarparkParams small_carpark() {
  CarparkParams params = short_drives();
  params.lanes.closed_lane_ratio = 0;
  params.drive.path_length_m = 200;
  return params;
}

/// Root mean square distance from the truth, all robots together, without any alignment.
double rms_error_m(const std::vector<Trajectory<SE3>>& estimates, const Truth& truth) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t r = 0; r < estimates.size(); ++r)
    for (const auto& [stamp, pose] : estimates[r])
      if (const auto expected = truth.robots[r].poses.at(stamp)) {
        squares += (expected->translation() - pose.translation()).head<2>().squaredNorm();
        ++count;
      }
  return std::sqrt(squares / static_cast<double>(count));
}

double estimate_error_m(const RunResult& result, const Truth& truth) {
  std::vector<Trajectory<SE3>> estimates;
  for (const auto& robot : result.robots) estimates.push_back(robot.estimate);
  return rms_error_m(estimates, truth);
}

double odometry_error_m(const RunResult& result, const Truth& truth) {
  std::vector<Trajectory<SE3>> odometry;
  for (const auto& robot : result.robots) odometry.push_back(robot.odometry);
  return rms_error_m(odometry, truth);
}

/// Every number of every pose, as a CSV would contain it.
std::vector<double> numbers(const RunResult& result) {
  std::vector<double> numbers;
  for (const auto& robot : result.robots) {
    for (const auto& [stamp, pose] : robot.estimate) {
      const Eigen::Vector3d t = pose.translation();
      const Eigen::Vector4d q = pose.rotation().coeffs();
      numbers.insert(numbers.end(), t.begin(), t.end());
      numbers.insert(numbers.end(), q.begin(), q.end());
    }
    numbers.push_back(robot.yaw_drift_per_m_rad);
    numbers.push_back(robot.scale_error);
  }
  for (const auto& closure : result.closures) numbers.push_back(closure.statistic);
  return numbers;
}

TEST(Pipeline, IsThreeTimesAsGoodAsDeadReckoning) {
  double reckoned = 0, estimated = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto [mission, truth] = simulate_carpark(small_carpark(), seed);
    const auto result = run_pipeline(mission, {}).result;
    reckoned += odometry_error_m(result, truth) / 3;
    estimated += estimate_error_m(result, truth) / 3;
    EXPECT_LT(2 * estimate_error_m(result, truth), odometry_error_m(result, truth)) << "seed " << seed;
    EXPECT_GT(result.counts.at("closures_accepted"), 100);
    EXPECT_EQ(result.components.size(), 1U);
    EXPECT_TRUE(result.unplaced.empty());
  }
  EXPECT_GT(reckoned, 3) << "the task is too easy";
  EXPECT_LT(3 * estimated, reckoned);
}

TEST(Pipeline, GivesTheSameNumbersForAnyNumberOfThreads) {
  auto params = small_carpark();
  params.known_start = false;
  params.drive.path_length_m = 120;
  const auto mission = simulate_carpark(params, 4).mission;
  set_thread_count(1);
  const auto alone = numbers(run_pipeline(mission, {}).result);
  set_thread_count(2);
  const auto together = numbers(run_pipeline(mission, {}).result);
  set_thread_count(0);
  ASSERT_GT(alone.size(), 1000U);
  EXPECT_EQ(alone, together);
}

TEST(Pipeline, WithoutWifiGivesOdometryBack) {
  for (const int dimension : {2, 3}) {
    auto mission = simulate_carpark(small_carpark(), 5).mission;
    mission.dimension = dimension;
    for (Robot& robot : mission.robots) robot.wifi.clear();
    const auto result = run_pipeline(mission, {}).result;
    ASSERT_EQ(result.robots.size(), 2U);
    for (std::size_t r = 0; r < 2; ++r) {
      const auto& robot = result.robots[r];
      ASSERT_GT(robot.estimate.size(), 100U);
      for (std::size_t k = 0; k < robot.estimate.size(); ++k) {
        const SE3 expected =
            *mission.robots[r].initial_pose * *mission.robots[r].odometry.at(robot.estimate[k].stamp);
        ASSERT_LT((expected.inverse() * robot.estimate[k].pose).log().norm(), 1e-5);
        ASSERT_LT((expected.inverse() * robot.odometry[k].pose).log().norm(), 1e-5) << "as rounded in logs";
      }
      EXPECT_NEAR(robot.yaw_drift_per_m_rad, 0, 1e-9);
    }
    EXPECT_TRUE(result.closures.empty());
  }
}

TEST(Pipeline, RobotsWithoutConnectionsAreListedUnplaced) {
  auto params = small_carpark();
  params.known_start = false;
  params.robots = 3;
  params.drive.path_length_m = 60;
  auto mission = simulate_carpark(params, 6).mission;
  mission.robots[1].wifi.clear();
  const auto result = run_pipeline(mission, {}).result;
  EXPECT_EQ(result.unplaced, std::vector<std::string>({"b"}));
  ASSERT_EQ(result.components.size(), 2U);
  EXPECT_EQ(result.components[0].robots, std::vector<std::string>({"a", "c"}));
  EXPECT_EQ(result.components[1].robots, std::vector<std::string>({"b"}));
  EXPECT_LT(result.robots[1].estimate.front().pose.log().norm(), 1e-6);  // in its own start frame
}

TEST(Pipeline, ReportsUnknownStartsInTheFirstRobotsFrame) {
  auto params = small_carpark();
  params.known_start = false;
  const auto [mission, truth] = simulate_carpark(params, 1);
  const auto result = run_pipeline(mission, {}).result;
  EXPECT_LT(result.robots[0].estimate.front().pose.log().norm(), 1e-9);
  EXPECT_GT(result.robots[1].estimate.front().pose.log().norm(), 1);
  Truth told = truth;
  const SE3 T_start_floor = truth.robots[0].poses.front().pose.inverse();
  for (auto& robot : told.robots) {
    std::vector<StampedPose<SE3>> poses(robot.poses.begin(), robot.poses.end());
    for (auto& [stamp, pose] : poses) pose = T_start_floor * pose;
    robot.poses = Trajectory<SE3>(std::move(poses));
  }
  EXPECT_LT(estimate_error_m(result, told), 4);  // on a floor of 40 m by 30 m
}

/// Odometry with these constant errors and hardly any others, along the true poses.
Trajectory<SE3> drifted(const Trajectory<SE3>& truth, double yaw_drift_per_m_rad, double scale) {
  std::vector<StampedPose<SE3>> rows{{truth.front().stamp, SE3()}};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    SE3::Tangent xi = (truth[i - 1].pose.inverse() * truth[i].pose).log();
    xi[5] += yaw_drift_per_m_rad * xi.head<3>().norm();
    xi.head<3>() *= 1 + scale;
    rows.push_back({truth[i].stamp, rows.back().pose * SE3::exp(xi)});
  }
  return Trajectory<SE3>(std::move(rows));
}

TEST(Pipeline, EstimatesTheYawDriftOfTheOdometry) {
  auto [mission, truth] = simulate_carpark(small_carpark(), 7);
  const double yaw_drifts[] = {0.003, -0.002};
  for (std::size_t r = 0; r < 2; ++r) {
    mission.robots[r].odometry = drifted(truth.robots[r].poses, yaw_drifts[r], 0);
    mission.robots[r].odometry_noise.sigma_yaw_drift_per_m_rad = 0.003;
  }
  const auto result = run_pipeline(mission, {}).result;
  // Fingerprints place a robot to about 2 m at either end of some 20 m, so to 0.1 rad of yaw after 200 m.
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_NEAR(result.robots[r].yaw_drift_per_m_rad, yaw_drifts[r], 0.1 / 200) << r;
}

TEST(Pipeline, EstimatesTheScaleErrorOfTheOdometry) {
  auto params = small_carpark();
  params.lanes.floor_x_m = 100;
  params.lanes.floor_y_m = 20;
  params.lanes.aisles_along_y = 3;
  params.lanes.aisles_along_x = 2;
  params.transmitters.access_points = 60;
  auto [mission, truth] = simulate_carpark(params, 7);
  const double scales[] = {-0.08, 0.08};
  for (std::size_t r = 0; r < 2; ++r) {
    mission.robots[r].odometry = drifted(truth.robots[r].poses, 0, scales[r]);
    mission.robots[r].odometry_noise.sigma_scale = 0.1;
  }
  const auto result = run_pipeline(mission, {}).result;
  for (std::size_t r = 0; r < 2; ++r) {
    // 2 m over the 90 m between the ends of the floor.
    EXPECT_NEAR(result.robots[r].scale_error, scales[r], 2.0 / 90) << r;
  }
}

TEST(Pipeline, ReportsItsStagesAndCounts) {
  auto params = small_carpark();
  params.drive.path_length_m = 60;
  const auto result = run_pipeline(simulate_carpark(params, 8).mission, {}).result;
  ASSERT_FALSE(result.timings.empty());
  EXPECT_EQ(result.timings.front().stage, "records");
  for (const auto& timing : result.timings) EXPECT_GE(timing.seconds, 0) << timing.stage;
  const double closures = result.counts.at("closures_accepted") + result.counts.at("closures_rejected");
  EXPECT_EQ(closures, static_cast<double>(result.closures.size()));
  for (const auto& closure : result.closures)
    EXPECT_EQ(closure.status == ClosureStatus::kRejected, !closure.reason.empty());
  EXPECT_EQ(result.counts.at("keyframes"),
            static_cast<double>(result.robots[0].estimate.size() + result.robots[1].estimate.size()));
}

}  // namespace
}  // namespace radioslam

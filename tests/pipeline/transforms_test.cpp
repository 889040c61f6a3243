// Transforms between the robots' frames, and their stated uncertainty.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/town_runs.hpp"

namespace radioslam {
namespace {

constexpr int kDim = 3;  // of a pose in the plane

SE2 true_start(const Truth& truth, const Mission& mission, std::size_t r) {
  return pose_as<SE2>(truth.robots[r].poses.at(mission.robots[r].odometry.front().stamp).value());
}

/// In the simulator, odometry frames start at the robots' true poses.
SE2 error_of(const TransformResult& transform, const Truth& truth, const Mission& mission) {
  return (true_start(truth, mission, 0).inverse() * true_start(truth, mission, 1)).inverse() *
         pose_as<SE2>(transform.T_i_j);
}

TEST(Transforms, HaveCalibratedUncertainty) {
  constexpr int kTeams = 20;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kTeams; ++seed) {
    const auto [mission, truth] = simulate_city(test::small_city(400), seed);
    const RunResult result = run_pipeline(mission, test::quick_params()).result;
    ASSERT_EQ(result.transforms.size(), 1U);
    const TransformResult& transform = result.transforms.front();
    ASSERT_EQ(transform.covariance.rows(), kDim);
    const Eigen::Vector3d error = error_of(transform, truth, mission).log();
    sum += error.dot(transform.covariance.inverse() * error);
  }
  const double chi2_sigma = std::sqrt(2.0 * kDim * kTeams);
  EXPECT_NEAR(sum, kDim * kTeams, 2 * chi2_sigma);
}

TEST(Transforms, FollowTheOdometryFrames) {
  auto [mission, truth] = simulate_city(test::small_city(400), 1);
  const TransformResult at_start = run_pipeline(mission, test::quick_params()).result.transforms.front();
  const SE3 T_new_old = lift(SE2({30, -4}, 0.8), 0);
  std::vector<StampedPose<SE3>> rows;
  for (const auto& row : mission.robots[1].odometry) rows.push_back({row.stamp, T_new_old * row.pose});
  mission.robots[1].odometry = Trajectory<SE3>(std::move(rows));
  const TransformResult moved = run_pipeline(mission, test::quick_params()).result.transforms.front();
  EXPECT_LT((at_start.T_i_j.inverse() * moved.T_i_j * T_new_old).log().norm(), 1e-6);
  const Eigen::Matrix3d into = pose_as<SE2>(T_new_old).adjoint();
  const Eigen::Matrix3d expected = into * at_start.covariance * into.transpose();
  EXPECT_LT((moved.covariance - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace radioslam

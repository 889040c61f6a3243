// Roll and pitch of recorded odometry stay as uncertain as gravity leaves them, however far a robot drives.
#include "radioslam/joint/level_priors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {
namespace {

constexpr double kSigmaLevel_rad = 0.03;

/// A robot that drives straight on, a sample per metre.
Mission drive(int metres, int dimension) {
  Mission mission;
  mission.dimension = dimension;
  Robot& robot = mission.robots.emplace_back();
  robot.id = "a";
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k <= metres; ++k)
    poses.push_back({Stamp::from_seconds(k), SE3({double(k), 0, 0}, Eigen::Quaterniond::Identity())});
  robot.odometry = Trajectory<SE3>(std::move(poses));
  return mission;
}

/// Covariance of the last pose with the first one's position and heading held.
SE3::Jacobian end_covariance(const Mission& mission) {
  auto graph = build_joint_graph<SE3>(mission, {}, {}).team.graph;
  PosePriorFactor<SE3> start;
  start.i = PoseId(0);
  start.prior = graph.poses[0];
  start.information = Eigen::Matrix<double, 6, 1>(1e8, 1e8, 1e8, 0, 0, 1e8).asDiagonal();
  graph.pose_priors.push_back(start);
  return Marginals<SE3>::compute(graph)->pose(PoseId(graph.poses.size() - 1));
}

TEST(LevelPriors, KeepTheTiltsStandardDeviationOverAnyDistance) {
  for (const int metres : {100, 500, 2000}) {
    const SE3::Jacobian covariance = end_covariance(drive(metres, 3));
    EXPECT_NEAR(std::sqrt(covariance(3, 3)) / kSigmaLevel_rad, 1, 0.15) << metres << " m";
    EXPECT_NEAR(std::sqrt(covariance(4, 4)) / kSigmaLevel_rad, 1, 0.15) << metres << " m";
  }
}

TEST(LevelPriors, LetTheHeightDriftWithTheSquareRootOfTheDistance) {
  const double near_m = std::sqrt(end_covariance(drive(1000, 3))(2, 2));
  const double far_m = std::sqrt(end_covariance(drive(4000, 3))(2, 2));
  EXPECT_NEAR(far_m / near_m, 2, 0.3) << "not eight times, as for a random walk of the tilt";
}

TEST(LevelPriors, AreNotAddedWhereTheNoiseWasMeasuredStepByStep) {
  Mission mission = drive(500, 3);
  const auto plain = build_joint_graph<SE3>(mission, {}, {}).team.graph.pose_priors.size();
  mission.robots[0].odometry_noise.steps.push_back(
      {Stamp::from_seconds(0), Stamp::from_seconds(500), 1e-4 * SE3::Jacobian::Identity()});
  const auto measured = build_joint_graph<SE3>(mission, {}, {}).team.graph.pose_priors.size();
  EXPECT_GT(plain, 3U);
  EXPECT_EQ(measured, 1U);
}

TEST(LevelPriors, AreNotAddedInThePlane) {
  EXPECT_TRUE(build_joint_graph<SE2>(drive(500, 2), {}, {}).team.graph.pose_priors.empty());
}

}  // namespace
}  // namespace radioslam

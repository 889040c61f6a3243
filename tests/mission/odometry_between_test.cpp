#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Twenty poses along a curve, one second apart.
Robot walker() {
  Robot robot;
  std::vector<StampedPose<SE3>> rows;
  SE2 pose({3, -2}, 0.4);
  for (int k = 0; k < 20; ++k) {
    rows.push_back({Stamp{k * kSecond}, lift(pose)});
    pose = pose * SE2({1.5, 0.1}, 0.15);
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.odometry_noise.sigma_yaw_drift_per_m_rad = 0.001;
  robot.odometry_noise.sigma_scale = 0.01;
  return robot;
}

TEST(OdometryBetween, IsTheEdgeBetweenItsRows) {
  const Robot robot = walker();
  const auto edge = odometry_edge<SE2>(robot.odometry, 3, 12, robot.odometry_noise);
  const auto between = odometry_between<SE2>(robot, Stamp{3 * kSecond}, Stamp{12 * kSecond});
  EXPECT_TRUE((between.pose.inverse() * edge.T_i_j).log().isZero(1e-12));
  const Eigen::Vector2d drift(1e-6, 1e-4);
  const Eigen::Matrix3d expected =
      edge.covariance + edge.drift_jacobian * drift.asDiagonal() * edge.drift_jacobian.transpose();
  EXPECT_TRUE(between.covariance.isApprox(expected, 1e-9));
}

TEST(OdometryBetween, BackwardsIsTheInverse) {
  const Robot robot = walker();
  const Stamp early{2'300'000'000}, late{11'700'000'000};
  const auto forward = odometry_between<SE3>(robot, early, late);
  const auto backward = odometry_between<SE3>(robot, late, early);
  EXPECT_TRUE((forward.pose * backward.pose).log().isZero(1e-12));
  EXPECT_TRUE(backward.inverse().covariance.isApprox(forward.covariance, 1e-9));
}

TEST(OdometryBetween, SinceTheStartIsThatFromTheFirstPose) {
  const Robot robot = walker();
  const std::vector<Stamp> stamps{Stamp{0}, Stamp{4 * kSecond}, Stamp{4 * kSecond}, Stamp{19 * kSecond}};
  const auto poses = odometry_since_start<SE2>(robot, stamps);
  ASSERT_EQ(poses.size(), 4U);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const SE2 recorded = flatten(*robot.odometry.at(stamps[k]));
    EXPECT_TRUE((poses[k].pose.inverse() * recorded).log().isZero(1e-9)) << k;
  }
  const auto whole = odometry_between<SE2>(robot, Stamp{0}, Stamp{19 * kSecond});
  EXPECT_TRUE(poses[3].covariance.isApprox(whole.covariance, 1e-3));  // up to the variance floor of an edge
  EXPECT_TRUE(poses[1].covariance.isApprox(poses[2].covariance));
}

/// Two legs of 3 m with a quarter turn between them and an error at the end of the first: 0.2 m forward is
/// then along y, and 0.1 rad displaces the end by 0.3 m sideways.
TEST(UncertainPose, ByHand) {
  UncertainPose<SE2> first{SE2({3, 0}, std::numbers::pi / 2), Eigen::Vector3d(0.04, 0, 0.01).asDiagonal()};
  const UncertainPose<SE2> second{SE2({3, 0}, 0), Eigen::Vector3d(0, 0, 0).asDiagonal()};
  const UncertainPose<SE2> both = first * second;
  EXPECT_NEAR(both.covariance(0, 0), 0.04, 1e-12);  // right perturbation: along the first leg's own end
  EXPECT_NEAR(both.covariance(1, 1), 0.01 * 9, 1e-12);
  EXPECT_NEAR(both.covariance(2, 2), 0.01, 1e-12);
  const Eigen::Matrix2d position = both.position_covariance();
  EXPECT_NEAR(position(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(position(1, 1), 0.04, 1e-12);
}

}  // namespace
}  // namespace radioslam

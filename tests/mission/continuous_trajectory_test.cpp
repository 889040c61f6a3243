#include "radioslam/mission/continuous_trajectory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

Stamp at_second(double t) { return Stamp::from_seconds(t); }

/// A winding path with odometry at 20 Hz.
Robot winding_robot(double end_s) {
  Robot robot;
  std::vector<StampedPose<SE3>> rows;
  SE3 pose({1, 2, 0.5}, Eigen::Quaterniond::Identity());
  for (int k = 0; 0.05 * k <= end_s; ++k) {
    rows.push_back({at_second(0.05 * k), pose});
    SE3::Tangent step;
    step << 0.05, 0.005 * std::sin(0.1 * k), 0.01 * std::cos(0.2 * k), 0.002, 0.004 * std::cos(0.15 * k),
        0.02;
    pose = pose * SE3::exp(step);
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  return robot;
}

template <class Pose>
typename Pose::Tangent drawn_tangent(Rng& rng, double sigma) {
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) xi[k] = rng.normal(0, sigma);
  return xi;
}

/// Keyframes one second apart, displaced from the odometry by random steps.
template <class Pose>
EstimatedKeyframes<Pose> moved_keyframes(const Robot& robot, double step, Rng& rng) {
  std::vector<StampedPose<Pose>> poses;
  Pose moved = Pose::exp(drawn_tangent<Pose>(rng, 1));
  for (double t = 0; t <= robot.odometry.back().stamp.seconds(); t += 0.97) {
    const Stamp stamp = at_second(t);
    const auto odometry = pose_as<Pose>(*robot.odometry.at(stamp));
    moved = moved * Pose::exp(drawn_tangent<Pose>(rng, step));
    poses.push_back({stamp, moved * odometry});
  }
  return {Trajectory<Pose>(std::move(poses)), {}};
}

template <class Pose>
double distance(const Pose& a, const Pose& b) {
  return (a.inverse() * b).log().norm();
}

template <class Pose>
class ContinuousTrajectoryOf : public testing::Test {};
using BothPoses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(ContinuousTrajectoryOf, BothPoses);

TYPED_TEST(ContinuousTrajectoryOf, PassesThroughItsKeyframes) {
  Rng rng(51);
  const Robot robot = winding_robot(10);
  const auto keyframes = moved_keyframes<TypeParam>(robot, 0.1, rng);
  const ContinuousTrajectory<TypeParam> trajectory(robot, keyframes);
  for (const auto& keyframe : keyframes.poses) {
    const auto pose = trajectory.at(keyframe.stamp);
    ASSERT_TRUE(pose);
    EXPECT_LT(distance(pose->pose, keyframe.pose), 1e-9);
    EXPECT_LT(pose->covariance.cwiseAbs().maxCoeff(), 1e-12);
    const Stamp just_before{keyframe.stamp.ns - 1000};
    if (!trajectory.covers(just_before)) continue;
    EXPECT_LT(distance(trajectory.at(just_before)->pose, keyframe.pose), 1e-5);
  }
  EXPECT_FALSE(trajectory.at(at_second(-0.001)));
  EXPECT_FALSE(trajectory.at(at_second(9.9)));
}

TYPED_TEST(ContinuousTrajectoryOf, HasTheShapeOfTheOdometryWhereNothingContradictsIt) {
  Rng rng(52);
  const Robot robot = winding_robot(10);
  const auto keyframes = moved_keyframes<TypeParam>(robot, 0, rng);
  const ContinuousTrajectory<TypeParam> trajectory(robot, keyframes);
  const TypeParam T = keyframes.poses[0].pose * pose_as<TypeParam>(robot.odometry[0].pose).inverse();
  for (double t = 0; t < 9.7; t += 0.013) {
    const auto odometry = pose_as<TypeParam>(*robot.odometry.at(at_second(t)));
    EXPECT_LT(distance(trajectory.at(at_second(t))->pose, TypeParam(T * odometry)), 1e-9) << t;
  }
}

TYPED_TEST(ContinuousTrajectoryOf, AsksForManyTimesAsForEach) {
  Rng rng(53);
  const Robot robot = winding_robot(10);
  const ContinuousTrajectory<TypeParam> trajectory(robot, moved_keyframes<TypeParam>(robot, 0.05, rng));
  std::vector<Stamp> stamps;
  for (double t = 0; t < 9.7; t += 0.1 * rng.uniform()) stamps.push_back(at_second(t));
  stamps.push_back(stamps.back());
  stamps.push_back(trajectory.keyframes().back().stamp);
  const auto all = trajectory.at(stamps);
  ASSERT_EQ(all.size(), stamps.size());
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const auto one = trajectory.at(stamps[k]);
    EXPECT_LT(distance(one->pose, all[k].pose), 1e-9);
    EXPECT_TRUE(one->covariance.isApprox(all[k].covariance, 1e-6) || one->covariance.norm() < 1e-12);
  }
}

/// Least squares over three poses k, t, m: two pose priors with joint covariance and odometry between
/// neighbours.
template <class Pose>
struct ThreePoses {
  static constexpr int kDof = Pose::kDof;
  using Vector = Eigen::Matrix<double, 4 * kDof, 1>;
  using Matrix = Eigen::Matrix<double, 3 * kDof, 3 * kDof>;

  std::array<Pose, 3> poses;
  UncertainPose<Pose> prior_k, prior_m, k_t, t_m;

  Vector residual(const std::array<Pose, 3>& at) const {
    const auto white = [](const UncertainPose<Pose>& measured, const Pose& actual) {
      const typename Pose::Tangent r = (measured.pose.inverse() * actual).log();
      return typename Pose::Tangent(measured.covariance.llt().matrixL().solve(r));
    };
    Vector r;
    r << white(prior_k, at[0]), white(prior_m, at[2]), white(k_t, at[0].inverse() * at[1]),
        white(t_m, at[1].inverse() * at[2]);
    return r;
  }

  /// Moves the poses to the minimum; returns their covariance.
  Matrix solve() {
    Matrix information;
    for (int round = 0; round < 10; ++round) {
      Eigen::Matrix<double, 4 * kDof, 3 * kDof> jacobian;
      for (int column = 0; column < 3 * kDof; ++column) {
        constexpr double h = 1e-6;
        const typename Pose::Tangent step = h * Pose::Tangent::Unit(column % kDof);
        const auto k = static_cast<std::size_t>(column / kDof);
        auto up = poses, down = poses;
        up[k] = up[k] * Pose::exp(step);
        down[k] = down[k] * Pose::exp(-step);
        jacobian.col(column) = (residual(up) - residual(down)) / (2 * h);
      }
      information = jacobian.transpose() * jacobian;
      const Eigen::Matrix<double, 3 * kDof, 1> step =
          -information.ldlt().solve(jacobian.transpose() * residual(poses));
      for (std::size_t k = 0; k < 3; ++k)
        poses[k] = poses[k] * Pose::exp(step.template segment<kDof>(static_cast<Eigen::Index>(k) * kDof));
    }
    return information.inverse();
  }
};

/// The interpolated pose and covariance equal those of a least squares problem that includes the pose.
TYPED_TEST(ContinuousTrajectoryOf, IsTheLeastSquaresWithThePoseInBetween) {
  using Pose = TypeParam;
  constexpr int kDof = Pose::kDof;
  Rng rng(54);
  const Robot robot = winding_robot(8);
  for (int n = 0; n < 5; ++n) {
    const Stamp k = at_second(rng.uniform(0, 2)), m = at_second(rng.uniform(4, 8));
    const Stamp t = at_second(rng.uniform(k.seconds() + 0.5, m.seconds() - 0.5));
    const Pose T = Pose::exp(drawn_tangent<Pose>(rng, 1));
    const auto prior = [&](Stamp stamp) {
      const Pose pose =
          T * pose_as<Pose>(*robot.odometry.at(stamp)) * Pose::exp(drawn_tangent<Pose>(rng, 0.02));
      const auto error = drawn_tangent<Pose>(rng, 0.02);
      typename Pose::Jacobian covariance = error * error.transpose();
      covariance.diagonal().array() += 0.01 * 0.01;
      return UncertainPose<Pose>{pose, covariance};
    };
    ThreePoses<Pose> dense{
        {}, prior(k), prior(m), odometry_between<Pose>(robot, k, t), odometry_between<Pose>(robot, t, m)};
    dense.poses = {dense.prior_k.pose, dense.prior_k.pose * dense.k_t.pose, dense.prior_m.pose};
    const auto covariance = dense.solve();

    EstimatedKeyframes<Pose> keyframes;
    keyframes.poses = Trajectory<Pose>({{k, dense.poses[0]}, {m, dense.poses[2]}});
    auto& joint = keyframes.covariances.emplace_back();
    joint << covariance.template block<kDof, kDof>(0, 0), covariance.template block<kDof, kDof>(0, 2 * kDof),
        covariance.template block<kDof, kDof>(2 * kDof, 0),
        covariance.template block<kDof, kDof>(2 * kDof, 2 * kDof);
    const auto between = ContinuousTrajectory<Pose>(robot, keyframes).at(t);
    const typename Pose::Jacobian expected = covariance.template block<kDof, kDof>(kDof, kDof);
    const typename Pose::Tangent off = (dense.poses[1].inverse() * between->pose).log();
    EXPECT_LT(off.dot(expected.llt().solve(off)), 1e-3);
    const typename Pose::Jacobian ratio = expected.llt().solve(between->covariance);
    EXPECT_LT((ratio - Pose::Jacobian::Identity()).cwiseAbs().maxCoeff(), 0.05) << ratio;
  }
}

/// Ten metres straight ahead, corrected by 0.1 m: half of it applies at the middle, whose error is that of a
/// Brownian bridge, a quarter of the whole path's variance. The correction of a robot at rest grows linearly
/// in time.
TEST(ContinuousTrajectory, ByHand) {
  Robot robot;
  robot.odometry = Trajectory<SE3>(
      {{at_second(0), SE3()}, {at_second(5), lift(SE2({10, 0}, 0))}, {at_second(9), lift(SE2({10, 0}, 0))}});
  robot.odometry_noise.sigma_xy_per_sqrt_m = 0.1;
  robot.odometry_noise.sigma_yaw_per_sqrt_m_rad = 0;
  EstimatedKeyframes<SE2> keyframes;
  keyframes.poses = Trajectory<SE2>(
      {{at_second(0), SE2()}, {at_second(5), SE2({10.1, 0}, 0)}, {at_second(9), SE2({10.1, 0.04}, 0)}});
  const ContinuousTrajectory<SE2> trajectory(robot, keyframes);
  const auto middle = *trajectory.at(at_second(2.5));
  EXPECT_TRUE(middle.pose.translation().isApprox(Eigen::Vector2d(5.05, 0), 1e-9));
  EXPECT_NEAR(middle.covariance(0, 0), 0.01 * 10 / 4, 1e-6);
  EXPECT_TRUE(trajectory.at(at_second(1))->pose.translation().isApprox(Eigen::Vector2d(2.02, 0), 1e-9));
  EXPECT_TRUE(trajectory.at(at_second(6))->pose.translation().isApprox(Eigen::Vector2d(10.1, 0.01), 1e-9));
}

/// A constant drift is removed: the trajectory then has the shape of the odometry without it.
TEST(ContinuousTrajectory, TakesAConstantDriftOut) {
  Robot robot;
  std::vector<StampedPose<SE3>> bent;
  for (int k = 0; k <= 100; ++k) {
    const double yaw = 0.01 * 0.1 * k;  // 0.01 rad/m, samples every 0.1 m
    bent.push_back({at_second(0.1 * k), lift(SE2({std::sin(yaw) / 0.01, (1 - std::cos(yaw)) / 0.01}, yaw))});
  }
  robot.odometry = Trajectory<SE3>(std::move(bent));
  EstimatedKeyframes<SE2> keyframes;
  keyframes.poses = Trajectory<SE2>({{at_second(0), SE2()}, {at_second(10), SE2({10, 0}, 0)}});
  keyframes.drift = {0.01, 0};
  const ContinuousTrajectory<SE2> straight(robot, keyframes);
  for (double t = 0; t < 10; t += 0.5)
    EXPECT_NEAR(straight.at(at_second(t))->pose.translation().y(), 0, 2e-3) << t;
}

}  // namespace
}  // namespace radioslam

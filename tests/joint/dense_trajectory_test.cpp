#include "radioslam/joint/dense_trajectory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr double kRows_hz = 200, kFixes_s = 1.5, kSigmaFix_m = 0.05;

/// A winding trajectory at 2 m/s, odometry with the noise that it states, and a few position fixes.
template <class Pose>
struct WindingWalk {
  Mission mission;
  std::vector<Pose> truth;  ///< at the odometry samples
  std::vector<PositionFix> fixes;
};

template <class Pose>
typename Pose::Tangent walk_noise(double distance_m, double turn_rad, const OdometryNoise& noise, Rng& rng) {
  const double xy = noise.sigma_xy_per_sqrt_m * std::sqrt(distance_m);
  const double yaw = std::hypot(noise.sigma_yaw_per_sqrt_m_rad * std::sqrt(distance_m),
                                noise.sigma_yaw_per_rad * std::sqrt(turn_rad));
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) xi[k] = rng.normal(0, k < Pose::kDim ? xy : yaw);
  if constexpr (Pose::kDim == 3) xi[2] = rng.normal(0, noise.sigma_z_per_sqrt_m * std::sqrt(distance_m));
  return xi;
}

template <class Pose>
WindingWalk<Pose> winding_walk(double duration_s, Rng rng) {
  WindingWalk<Pose> walk;
  walk.mission.dimension = Pose::kDim;
  Robot& robot = walk.mission.robots.emplace_back();
  robot.id = "a";
  robot.initial_pose = SE3();
  const JointGraphParams params;
  typename Pose::Tangent start;
  for (int k = 0; k < Pose::kDof; ++k)
    start[k] = rng.normal(0, k < Pose::kDim ? params.sigma_start_m : params.sigma_start_rad);
  Pose truth = Pose::exp(start), odometry;
  std::vector<StampedPose<SE3>> rows;
  const int count = static_cast<int>(duration_s * kRows_hz);
  for (int k = 0; k <= count; ++k) {
    const double t = k / kRows_hz;
    rows.push_back({Stamp::from_seconds(t), as_se3(odometry, 0)});
    walk.truth.push_back(truth);
    if (k > 0 && k % static_cast<int>(kFixes_s * kRows_hz) == 0) {
      PositionFix fix{rows.back().stamp, as_se3(truth, 0).translation(), kSigmaFix_m};
      for (int axis = 0; axis < Pose::kDim; ++axis) fix.position_m[axis] += rng.normal(0, kSigmaFix_m);
      walk.fixes.push_back(fix);
    }
    typename Pose::Tangent step = Pose::Tangent::Zero();
    step[0] = 2 / kRows_hz;
    step[Pose::kDof - 1] = 0.4 * std::sin(0.8 * t) / kRows_hz;
    const Pose motion = Pose::exp(step);
    truth = truth * motion;
    const auto noise = walk_noise<Pose>(step[0], std::abs(step[Pose::kDof - 1]), robot.odometry_noise, rng);
    odometry = odometry * motion * Pose::exp(noise);
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  return walk;
}

/// The joint graph of a trajectory, solved with the fixes on the nearest keyframes' poses.
template <class Pose>
JointGraph<Pose> solved_graph(const WindingWalk<Pose>& walk) {
  auto joint = build_joint_graph<Pose>(walk.mission, {}, {});
  for (const PositionFix& fix : walk.fixes) {
    const RobotVariables& robot = joint.robots.front();
    const std::size_t k = keyframe_before(robot.stamps, fix.stamp);
    PositionFactor<Pose> factor;
    factor.i.pose = robot.poses[k];
    const SE3 here = *walk.mission.robots[0].odometry.at(fix.stamp);
    factor.i.lever_arm = (pose_as<Pose>(robot.odometry[k]).inverse() * pose_as<Pose>(here)).translation();
    factor.position = fix.position_m.template head<Pose::kDim>();
    factor.information /= kSigmaFix_m * kSigmaFix_m;
    joint.team.graph.positions.push_back(factor);
  }
  optimize(joint.team.graph, {});
  return joint;
}

template <class Pose>
RobotResult keyframes_of(const JointGraph<Pose>& joint) {
  RobotResult result;
  result.id = "a";
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < joint.robots[0].poses.size(); ++k)
    rows.push_back(
        {joint.robots[0].stamps[k], as_se3(joint.team.graph.poses[joint.robots[0].poses[k].index()], 0)});
  result.estimate = Trajectory<SE3>(std::move(rows));
  return result;
}

template <class Pose>
class DenseTrajectories : public testing::Test {};
using BothDimensions = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(DenseTrajectories, BothDimensions);

/// Between the keyframes, at 200 Hz, the error is hardly larger than at them, and the covariance matches it.
TYPED_TEST(DenseTrajectories, AreAsAccurateAsTheirKeyframesWithMatchingCovariance) {
  using Pose = TypeParam;
  constexpr int kRuns = 200;
  double squared_rows = 0, squared_keyframes = 0, nees = 0;
  std::size_t rows = 0, keyframes = 0;
  for (int run = 0; run < kRuns; ++run) {
    Rng rng = Rng(61).split(static_cast<std::uint64_t>(run));
    const auto walk = winding_walk<Pose>(5, rng);
    const auto joint = solved_graph(walk);
    const auto marginals = Marginals<Pose>::compute(joint.team.graph);
    ASSERT_TRUE(marginals);
    const RobotResult estimate = keyframes_of(joint);
    const auto dense = dense_trajectory(walk.mission, joint, &*marginals, 0, estimate);
    ASSERT_EQ(dense.poses.size(), walk.truth.size());
    const auto squared_error = [&](std::size_t k) {
      return (dense.poses[k].pose.translation() - as_se3(walk.truth[k], 0).translation()).squaredNorm();
    };
    for (std::size_t k = 0; k < walk.truth.size(); ++k, ++rows) squared_rows += squared_error(k);
    for (const Stamp stamp : joint.robots[0].stamps) {
      squared_keyframes += squared_error(static_cast<std::size_t>(std::lround(stamp.seconds() * kRows_hz)));
      ++keyframes;
    }
    const std::size_t k = rng.split("row").below(walk.truth.size());
    const auto continuous = continuous_trajectory(walk.mission, joint, &*marginals, 0, estimate);
    const auto pose = *continuous->at(walk.mission.robots[0].odometry[k].stamp);
    const typename Pose::Tangent error = (pose.pose.inverse() * walk.truth[k]).log();
    nees += error.dot(pose.covariance.llt().solve(error));
  }
  const double ratio = std::sqrt(squared_rows / static_cast<double>(rows)) /
                       std::sqrt(squared_keyframes / static_cast<double>(keyframes));
  testing::Test::RecordProperty("ratio", std::to_string(ratio));
  testing::Test::RecordProperty("nees", std::to_string(nees / kRuns));
  EXPECT_LT(ratio, 1.2);
  EXPECT_GT(nees, chi_squared_quantile(0.025, Pose::kDof * kRuns));
  EXPECT_LT(nees, chi_squared_quantile(0.975, Pose::kDof * kRuns));
}

TEST(DenseTrajectory, HoldsTheKeyframesInTheirFrame) {
  const auto walk = winding_walk<SE2>(5, Rng(62));
  const auto joint = solved_graph(walk);
  RobotResult estimate = keyframes_of(joint);
  const SE3 T = lift(SE2({5, -3}, 2));
  std::vector<StampedPose<SE3>> moved;
  for (const auto& row : estimate.estimate) moved.push_back({row.stamp, T * row.pose});
  estimate.estimate = Trajectory<SE3>(std::move(moved));
  const auto marginals = Marginals<SE2>::compute(joint.team.graph);
  const auto dense = dense_trajectory(walk.mission, joint, &*marginals, 0, estimate, joint.robots[0].stamps);
  ASSERT_EQ(dense.poses.size(), estimate.estimate.size());
  ASSERT_EQ(dense.sigma_position_m.size(), estimate.estimate.size());
  for (std::size_t k = 0; k < dense.poses.size(); ++k) {
    const SE3 off = dense.poses[k].pose.inverse() * estimate.estimate[k].pose;
    EXPECT_LT(off.log().norm(), 1e-9);
    const auto covariance = marginals->pose(joint.robots[0].poses[k]);
    EXPECT_NEAR(dense.sigma_position_m[k], std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2), 1e-6);
  }
}

TEST(DenseTrajectory, LeavesOutWhatIsNotCovered) {
  auto walk = winding_walk<SE2>(2, Rng(63));
  const auto joint = solved_graph(walk);
  const RobotResult estimate = keyframes_of(joint);
  const std::vector<Stamp> stamps{Stamp::from_seconds(-1), Stamp::from_seconds(1), Stamp::from_seconds(3)};
  const auto dense = dense_trajectory<SE2>(walk.mission, joint, nullptr, 0, estimate, stamps);
  EXPECT_EQ(dense.poses.size(), 1U);
  EXPECT_TRUE(dense.sigma_position_m.empty());
  walk.mission.robots[0].odometry = {};
  EXPECT_TRUE(dense_trajectory<SE2>(walk.mission, joint, nullptr, 0, estimate, stamps).poses.empty());
}

/// Moved as a whole, the path is the same; where its end is not the estimate's, it is bent evenly in time.
TYPED_TEST(DenseTrajectories, FollowAFinerPathFromRowToRow) {
  using Pose = TypeParam;
  const auto walk = winding_walk<Pose>(3, Rng(64));
  const Trajectory<SE3>& path = walk.mission.robots[0].odometry;
  const SE3 T = lift(SE2({5, -3}, 2)), bend = lift(SE2({0.1, 0}, 0));
  const auto every_fifth = [&](const SE3& end) {
    std::vector<StampedPose<SE3>> rows;
    for (std::size_t k = 10; k <= 20; k += 5) rows.push_back({path[k].stamp, T * path[k].pose});
    rows.back().pose = rows.back().pose * end;
    return Trajectory<SE3>(std::move(rows));
  };
  const auto rigid = along_path<Pose>(every_fifth(SE3()), path),
             bent = along_path<Pose>(every_fifth(bend), path);
  ASSERT_EQ(rigid.size(), 11U);
  ASSERT_EQ(bent.size(), 11U);
  for (std::size_t k = 0; k < rigid.size(); ++k) {
    EXPECT_EQ(rigid[k].stamp, path[10 + k].stamp);
    EXPECT_LT((rigid[k].pose.inverse() * (T * path[10 + k].pose)).log().norm(), 1e-9);
    const double share = k < 5 ? 0 : static_cast<double>(k - 5) / 5;
    EXPECT_NEAR((rigid[k].pose.inverse() * bent[k].pose).log()[0], 0.1 * share, 1e-9);
  }
}

}  // namespace
}  // namespace radioslam

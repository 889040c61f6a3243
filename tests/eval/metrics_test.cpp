#include "radioslam/eval/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "eval/teams.hpp"

namespace radioslam {
namespace {

using test::changed;
using test::estimate_from;
using test::noise;
using test::winding_team;

const auto kExact = [](const SE3& pose) { return pose; };

/// Points of the plane as complex numbers: the best rotation is the phase of sum conj(source) target.
std::vector<double> errors_by_complex_numbers(std::vector<std::complex<double>> source,
                                              std::vector<std::complex<double>> target) {
  const auto centre = [](std::vector<std::complex<double>>& points) {
    const auto sum = std::accumulate(points.begin(), points.end(), std::complex<double>{});
    for (auto& point : points) point -= sum / static_cast<double>(points.size());
  };
  centre(source);
  centre(target);
  std::complex<double> correlation;
  for (std::size_t i = 0; i < source.size(); ++i) correlation += std::conj(source[i]) * target[i];
  const auto rotation = correlation / std::abs(correlation);
  std::vector<double> errors;
  for (std::size_t i = 0; i < source.size(); ++i)
    errors.push_back(std::abs(rotation * source[i] - target[i]));
  return errors;
}

TEST(TeamMetrics, AgreesWithAComputationInComplexNumbers) {
  const Truth truth = winding_team(1, 3);
  Rng rng(2);
  const auto estimate = estimate_from(truth, noise(rng));
  std::vector<std::complex<double>> source, target;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t i = 0; i < truth.robots[r].poses.size(); ++i) {
      const auto& p = estimate[r].poses[i].pose.translation();
      const auto& q = truth.robots[r].poses[i].pose.translation();
      source.emplace_back(p.x(), p.y());
      target.emplace_back(q.x(), q.y());
    }
  auto errors = errors_by_complex_numbers(source, target);
  const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  std::sort(errors.begin(), errors.end());

  const auto metrics = evaluate_trajectories(estimate, truth, 2);
  ASSERT_TRUE(metrics.ate);
  EXPECT_EQ(metrics.ate->count, 120U);
  EXPECT_NEAR(metrics.ate->mean_m, sum / 120, 1e-12);
  EXPECT_NEAR(metrics.ate->rmse_m, std::sqrt(squares / 120), 1e-12);
  EXPECT_NEAR(metrics.ate->median_m, (errors[59] + errors[60]) / 2, 1e-12);
  EXPECT_NEAR(metrics.ate->p90_m, 0.9 * errors[107] + 0.1 * errors[108], 1e-12);  // position 107.1
  EXPECT_DOUBLE_EQ(metrics.coverage, 1);
}

class InBothDimensions : public ::testing::TestWithParam<int> {
 protected:
  int dimension() const { return GetParam(); }
  SE3 motion() const {
    const SE3 motion = SE3::exp((SE3::Tangent() << 30, -7, 4, 0.3, -0.8, 2.1).finished());
    return dimension() == 2 ? lift(flatten(motion)) : motion;
  }
};
INSTANTIATE_TEST_SUITE_P(TeamMetrics, InBothDimensions, ::testing::Values(2, 3));

TEST_P(InBothDimensions, AnExactEstimateHasNoError) {
  const Truth truth = winding_team(3, 2);
  const auto metrics = evaluate_trajectories(estimate_from(truth, kExact), truth, dimension());
  EXPECT_LT(metrics.ate->rmse_m, 1e-12);
  EXPECT_LT(metrics.rpe->translation_rmse_m, 1e-12);
  EXPECT_LT(metrics.rpe->rotation_rmse_rad, 1e-12);
  EXPECT_LT(metrics.T_truth_estimate.log().norm(), 1e-12);
}

TEST_P(InBothDimensions, MovingTheWholeTeamRigidlyChangesNothing) {
  const Truth truth = winding_team(4, 2);
  Rng rng(5);
  auto estimate = estimate_from(truth, noise(rng));
  const auto before = evaluate_trajectories(estimate, truth, dimension());
  for (auto& robot : estimate)
    robot.poses = changed(robot.poses, [this](const SE3& pose) { return motion() * pose; });
  const auto after = evaluate_trajectories(estimate, truth, dimension());
  EXPECT_NEAR(after.ate->rmse_m, before.ate->rmse_m, 1e-9);
  EXPECT_NEAR(after.ate->median_m, before.ate->median_m, 1e-9);
  EXPECT_NEAR(after.rpe->translation_rmse_m, before.rpe->translation_rmse_m, 1e-9);
  EXPECT_NEAR(after.rpe->rotation_rmse_rad, before.rpe->rotation_rmse_rad, 1e-9);
  EXPECT_LT((after.T_truth_estimate * motion() * before.T_truth_estimate.inverse()).log().norm(), 1e-9);
}

TEST_P(InBothDimensions, MovingOneRobotAloneIsAnError) {
  const Truth truth = winding_team(6, 2);
  auto estimate = estimate_from(truth, kExact);
  estimate[1].poses = changed(estimate[1].poses, [](const SE3& pose) { return lift(SE2({8, 0}, 0)) * pose; });
  const auto metrics = evaluate_trajectories(estimate, truth, dimension());
  EXPECT_GT(metrics.ate->rmse_m, 1);
  EXPECT_LT(metrics.rpe->translation_rmse_m, 1e-9);  // relative motion is still correct
}

TEST_P(InBothDimensions, AMirroredEstimateIsWrong) {
  const Truth truth = winding_team(7, 2);
  const auto mirrored = estimate_from(truth, [](const SE3& pose) {
    const auto& p = pose.translation();
    return SE3({p.x(), -p.y(), p.z()}, pose.rotation());
  });
  EXPECT_GT(evaluate_trajectories(mirrored, truth, dimension()).ate->rmse_m, 1);
}

TEST(TeamMetrics, ThePlaneIgnoresHeightAndTilt) {
  const Truth truth = winding_team(8, 2);
  const auto lifted =
      estimate_from(truth, [](const SE3& pose) { return lift(flatten(pose), pose.translation().x() * 3); });
  EXPECT_LT(evaluate_trajectories(lifted, truth, 2).ate->rmse_m, 1e-12);
  EXPECT_GT(evaluate_trajectories(lifted, truth, 3).ate->rmse_m, 0.1);
}

TEST(TeamMetrics, ErrorsByHand) {
  // Two robots on parallel lines; every pose of the second is estimated one metre too far to the side. The
  // best alignment of the team shifts both by half of that.
  const auto line = [](double y, double offset) {
    std::vector<StampedPose<SE3>> poses;
    for (const double x : {0.0, 3.0, 6.0})
      poses.push_back({Stamp::from_seconds(x), lift(SE2({x, y + offset}, 0))});
    return Trajectory<SE3>(poses);
  };
  const Truth truth{{{"a", line(0, 0)}, {"b", line(10, 0)}}};
  const auto metrics = evaluate_trajectories({{"b", line(10, 1)}, {"a", line(0, 0)}}, truth, 2);
  EXPECT_NEAR(metrics.ate->rmse_m, 0.5, 1e-12);
  EXPECT_NEAR(metrics.ate->p90_m, 0.5, 1e-12);
  EXPECT_LT((metrics.T_truth_estimate.translation() - Eigen::Vector3d(0, -0.5, 0)).norm(), 1e-12);
  ASSERT_EQ(metrics.robots.size(), 2U);
  EXPECT_EQ(metrics.robots[0].id, "a");
  ASSERT_EQ(metrics.robots[1].errors.size(), 3U);
  EXPECT_DOUBLE_EQ(metrics.robots[1].errors[2].along_m, 6);
  EXPECT_NEAR(metrics.robots[1].errors[2].error_m, 0.5, 1e-12);
}

TEST(TeamMetrics, RelativeErrorByHand) {
  // Each step of the estimate is 0.1 m too long and rotates 0.02 rad too much.
  std::vector<StampedPose<SE3>> truth_poses, estimated;
  SE2 true_pose, pose;
  for (int i = 0; i < 5; ++i) {
    truth_poses.push_back({Stamp::from_seconds(i), lift(true_pose)});
    estimated.push_back({Stamp::from_seconds(i), lift(pose)});
    true_pose = true_pose * SE2({1, 0}, 0.5);
    pose = pose * SE2({1.1, 0}, 0.52);
  }
  const Truth truth{{{"a", Trajectory<SE3>(truth_poses)}}};
  const auto metrics = evaluate_trajectories({{"a", Trajectory<SE3>(estimated)}}, truth, 2);
  ASSERT_TRUE(metrics.rpe);
  EXPECT_EQ(metrics.rpe->count, 4U);
  EXPECT_NEAR(metrics.rpe->translation_rmse_m, 0.1, 1e-12);
  EXPECT_NEAR(metrics.rpe->rotation_rmse_rad, 0.02, 1e-12);
}

TEST(TeamMetrics, WaypointsHaveNoRelativeError) {
  Truth truth = winding_team(9, 1);
  truth.robots[0].has_orientation = false;
  const auto metrics = evaluate_trajectories(estimate_from(truth, kExact), truth, 2);
  EXPECT_FALSE(metrics.rpe);
  EXPECT_LT(metrics.ate->rmse_m, 1e-12);
}

TEST(TeamMetrics, AMissingRobotCountsInCoverage) {
  const Truth truth = winding_team(10, 2);
  auto estimate = estimate_from(truth, kExact);
  estimate.pop_back();
  const auto metrics = evaluate_trajectories(estimate, truth, 2);
  EXPECT_DOUBLE_EQ(metrics.coverage, 0.5);
  EXPECT_DOUBLE_EQ(metrics.robots[0].coverage, 1);
  EXPECT_DOUBLE_EQ(metrics.robots[1].coverage, 0);
  EXPECT_FALSE(metrics.robots[1].ate);
  EXPECT_EQ(metrics.ate->count, 40U);
}

TEST(TeamMetrics, NothingIsInterpolatedAcrossPosesThatAreNotPlaced) {
  const auto row = [](double t_s) {
    return StampedPose<SE3>{Stamp::from_seconds(t_s), SE3({t_s, 0, 0}, {})};
  };
  Truth truth{{{"a", Trajectory<SE3>({row(0), row(1), row(1.5), row(2), row(3)})}}};
  EstimatedTrajectory estimate{"a", Trajectory<SE3>({row(0), row(1), row(3)})};
  EXPECT_DOUBLE_EQ(evaluate_trajectories({estimate}, truth, 3).coverage, 1);
  estimate.untied = {{Stamp::from_seconds(2), Stamp::from_seconds(2)}};
  EXPECT_DOUBLE_EQ(evaluate_trajectories({estimate}, truth, 3).coverage, 0.6);
}

TEST(TeamMetrics, WithoutAnythingInCommonThereIsNoError) {
  const auto metrics = evaluate_trajectories({}, winding_team(11, 2), 3);
  EXPECT_FALSE(metrics.ate);
  EXPECT_FALSE(metrics.rpe);
  EXPECT_DOUBLE_EQ(metrics.coverage, 0);
  EXPECT_DOUBLE_EQ(evaluate_trajectories({}, {}, 2).coverage, 0);
}

/// Normal errors of .4 m per axis: 98.9 % are within three standard deviations in the plane.
TEST(TeamMetrics, CountsErrorsWithinThreeStatedStandardDeviations) {
  const Truth truth = winding_team(14, 2, 2000);
  Rng rng(15);
  auto estimate = estimate_from(truth, noise(rng));
  EXPECT_FALSE(evaluate_trajectories(estimate, truth, 2).consistency);
  EXPECT_FALSE(evaluate_trajectories(estimate, truth, 2).team_consistency);
  const auto with = [&](double sigma_m) {
    for (auto& robot : estimate) {
      robot.sigma_position_m.assign(robot.poses.size(), sigma_m);
      robot.sigma_team_m.assign(robot.poses.size(), sigma_m / 2);
    }
    return evaluate_trajectories(estimate, truth, 2);
  };
  const auto share = [&](double sigma_m) { return with(sigma_m).consistency->share_within_3_sigma; };
  EXPECT_NEAR(share(0.4), 1 - std::exp(-4.5), 0.01);
  EXPECT_NEAR(share(0.4 / 3), 1 - std::exp(-0.5), 0.03);
  EXPECT_EQ(share(100), 1);
  EXPECT_NEAR(with(0.4).consistency->mean_square, 1, 0.05);
  EXPECT_NEAR(with(0.4).team_consistency->mean_square, 4, 0.2);
}

TEST(TeamMetrics, StatedStandardDeviationsAreLinearBetweenPoses) {
  const Truth truth = winding_team(16, 1, 3);
  auto estimate = estimate_from(truth, kExact);
  const auto& poses = truth.robots[0].poses;
  // Only the first and the last pose are estimated; the second, between them, is off by the path's bend.
  estimate[0].poses = Trajectory<SE3>({{poses[0].stamp, poses[0].pose}, {poses[2].stamp, poses[2].pose}});
  const double bend_m = evaluate_trajectories(estimate, truth, 2).robots[0].errors[1].error_m;
  ASSERT_GT(bend_m, 1e-3);
  const auto share = [&](double last_m) {
    estimate[0].sigma_position_m = {1e-9, last_m};
    return evaluate_trajectories(estimate, truth, 2).consistency->share_within_3_sigma;
  };
  const double just_enough_m = 2 * bend_m / 3;
  EXPECT_GT(share(1.01 * just_enough_m), share(0.99 * just_enough_m));
}

TEST(TeamMetrics, BothAssociationsAgreeOnEqualStamps) {
  const Truth truth = winding_team(12, 2);
  Rng rng(13);
  const auto estimate = estimate_from(truth, noise(rng));
  EXPECT_NEAR(evaluate_trajectories(estimate, truth, 3, Association::kNearest).ate->rmse_m,
              evaluate_trajectories(estimate, truth, 3).ate->rmse_m, 1e-12);
}

}  // namespace
}  // namespace radioslam

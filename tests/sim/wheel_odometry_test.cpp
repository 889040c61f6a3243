#include "radioslam/sim/sensors/wheel_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/sim/motion/drive.hpp"

namespace radioslam {
namespace {

/// A drive of 600 m, a pose every 8 cm.
std::vector<SE2> true_poses(std::uint64_t seed) {
  const Rng rng(seed);
  const LaneGrid lanes(LaneGridParams{}, rng.split("lanes"));
  std::vector<Eigen::Vector2d> corners;
  for (const std::size_t i : draw_route(lanes, 0, 800, rng.split("route")))
    corners.push_back(lanes.crossing(i));
  const Drive drive(corners, DriveParams{}, rng.split("wander"));
  std::vector<SE2> poses;
  for (int i = 0; i <= 7500; ++i) poses.push_back(drive.pose_at(0.08 * i));
  return poses;
}

TEST(WheelOdometry, WithoutNoiseIsTheTruthFromTheStart) {
  WheelOdometryParams params;
  params.sigma_xy_per_sqrt_m = params.sigma_yaw_per_sqrt_m_rad = params.sigma_yaw_per_rad = 0;
  params.sigma_yaw_drift_per_m_rad = params.sigma_scale = 0;
  params.draws = 1;
  const auto truth = true_poses(1);
  const auto result = draw_dead_reckoning(truth, params, Rng(1));
  ASSERT_EQ(result.T_start_body.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_LT((truth[i].inverse() * truth.front() * result.T_start_body[i]).log().norm(), 1e-8);
}

/// With drift and scale error removed, each increment's error has the stated variance, whatever the division
/// of the path: sums of squared normalised errors are chi-square.
void expect_chi_square(std::size_t stride) {
  const WheelOdometryParams params;
  const OdometryNoise stated = stated_noise(params);
  const auto truth = true_poses(2);
  double position_squares = 0, yaw_squares = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto result = draw_dead_reckoning(truth, params, Rng(seed));
    for (std::size_t begin = 0; begin + stride < truth.size(); begin += stride) {
      double way_m = 0, turn_rad = 0, yaw_error = 0;
      Eigen::Vector2d error = Eigen::Vector2d::Zero();
      for (std::size_t i = begin; i < begin + stride; ++i) {
        const SE2::Tangent was = (truth[i].inverse() * truth[i + 1]).log();
        const SE2::Tangent seen = (result.T_start_body[i].inverse() * result.T_start_body[i + 1]).log();
        const double step_m = was.head<2>().norm();
        way_m += step_m;
        turn_rad += std::abs(was.z());
        yaw_error += seen.z() - was.z() - result.errors.yaw_drift_per_m_rad * step_m;
        error += seen.head<2>() - (1 + result.errors.scale) * was.head<2>();
      }
      const double yaw_variance = std::pow(stated.sigma_yaw_per_sqrt_m_rad, 2) * way_m +
                                  std::pow(stated.sigma_yaw_per_rad, 2) * turn_rad;
      yaw_squares += yaw_error * yaw_error / yaw_variance;
      position_squares += error.squaredNorm() / (std::pow(stated.sigma_xy_per_sqrt_m, 2) * way_m);
      ++count;
    }
  }
  // Five standard errors of a chi-square mean: variance 2 per degree of freedom.
  EXPECT_NEAR(yaw_squares / count, 1, 5 * std::sqrt(2.0 / count));
  EXPECT_NEAR(position_squares / count, 2, 5 * std::sqrt(4.0 / count));
}

TEST(WheelOdometry, HasTheStatedNoiseFromRowToRow) { expect_chi_square(1); }
TEST(WheelOdometry, HasTheStatedNoiseOverFourMetres) { expect_chi_square(50); }

TEST(WheelOdometry, DriftCurvesAStraightLine) {
  WheelOdometryParams params;
  params.sigma_xy_per_sqrt_m = params.sigma_yaw_per_sqrt_m_rad = params.sigma_yaw_per_rad = 0;
  params.sigma_scale = 0;
  std::vector<SE2> line;
  for (int i = 0; i <= 100; ++i) line.emplace_back(Eigen::Vector2d(i, 0), 0);
  params.draws = 1;
  const auto result = draw_dead_reckoning(line, params, Rng(4));
  EXPECT_NEAR(result.T_start_body.back().angle(), 100 * result.errors.yaw_drift_per_m_rad, 1e-9);
  EXPECT_NE(result.errors.yaw_drift_per_m_rad, 0);
  EXPECT_EQ(result.errors.scale, 0);
}

TEST(WheelOdometry, EndsAsFarOffAsAskedFor) {
  WheelOdometryParams params;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto truth = true_poses(seed);
    const auto result = draw_dead_reckoning(truth, params, Rng(seed));
    const SE2 end = truth.front() * result.T_start_body.back();
    EXPECT_NEAR((end.translation() - truth.back().translation()).norm(), result.end_error_m, 1e-9);
    EXPECT_GE(result.end_error_m, 10);
    EXPECT_LE(result.end_error_m, 20);
  }
}

TEST(WheelOdometry, TakesTheNearestWhenNoDrawFits) {
  WheelOdometryParams params;
  params.end_error_min_m = params.end_error_max_m = 1000;
  params.draws = 1;
  const auto truth = true_poses(1);
  const double first = draw_dead_reckoning(truth, params, Rng(1)).end_error_m;
  params.draws = 20;
  EXPECT_GT(draw_dead_reckoning(truth, params, Rng(1)).end_error_m, first);
}

TEST(WheelOdometry, StatesItsNoiseExactlyOrByAFactor) {
  WheelOdometryParams params;
  EXPECT_EQ(stated_noise(params).sigma_yaw_drift_per_m_rad, params.sigma_yaw_drift_per_m_rad);
  params.stated_noise_factor = 0.5;
  const OdometryNoise noise = stated_noise(params);
  EXPECT_EQ(noise.sigma_xy_per_sqrt_m, 0.5 * params.sigma_xy_per_sqrt_m);
  EXPECT_EQ(noise.sigma_yaw_per_sqrt_m_rad, 0.5 * params.sigma_yaw_per_sqrt_m_rad);
  EXPECT_EQ(noise.sigma_yaw_per_rad, 0.5 * params.sigma_yaw_per_rad);
  EXPECT_EQ(noise.sigma_yaw_drift_per_m_rad, 0.5 * params.sigma_yaw_drift_per_m_rad);
  EXPECT_EQ(noise.sigma_scale, 0.5 * params.sigma_scale);
}

/// Draws are selected by their end error; the selected ones must still have the stated standard deviation.
TEST(WheelOdometry, SelectedDriftsHaveTheStatedSpread) {
  const WheelOdometryParams params;
  double drift_squares = 0, scale_squares = 0;
  constexpr int n = 100;
  for (std::uint64_t seed = 0; seed < n; ++seed) {
    std::vector<SE2> coarse;
    const auto truth = true_poses(seed);
    for (std::size_t i = 0; i < truth.size(); i += 10) coarse.push_back(truth[i]);
    const ConstantErrors errors = draw_dead_reckoning(coarse, params, Rng(seed)).errors;
    drift_squares += std::pow(errors.yaw_drift_per_m_rad / params.sigma_yaw_drift_per_m_rad, 2);
    scale_squares += std::pow(errors.scale / params.sigma_scale, 2);
  }
  EXPECT_NEAR(std::sqrt(drift_squares / n), 1, 0.3);
  EXPECT_NEAR(std::sqrt(scale_squares / n), 1, 0.3);
}

}  // namespace
}  // namespace radioslam

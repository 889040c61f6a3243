#include "radioslam/inertial/inertial_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "inertial/simulated_drive.hpp"
#include "radioslam/consistency/chi_squared.hpp"

namespace radioslam {
namespace {

using test::DrivePlan;
using test::simulate_drive;
using test::SimulatedDrive;

constexpr Eigen::Index kDof = InertialState::kDof;

double squared_norm(const InertialState::Tangent& error, const InertialState::Jacobian& covariance) {
  return error.dot(covariance.llt().solve(error));
}

/// With little ambiguity between tilt and bias, so that errors stay within the first order.
ImuNoiseParams good_unit() {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 0.05;
  return noise;
}

/// Whether `sum` is within the 95 % band of chi-squared with `dof` degrees of freedom.
testing::AssertionResult in_band(double sum, int dof) {
  const double low = chi_squared_quantile(0.025, dof), high = chi_squared_quantile(0.975, dof);
  if (low <= sum && sum <= high) return testing::AssertionSuccess();
  return testing::AssertionFailure() << sum / dof << " per dimension, band " << low / dof << " to "
                                     << high / dof;
}

/// The whitened residuals of a drive as one dense vector.
Eigen::VectorXd whitened(const SimulatedDrive& sim, const std::vector<InertialState>& states,
                         const std::vector<InertialBias>& summed_for, const ImuNoiseParams& noise,
                         const InertialSmootherParams& params) {
  std::vector<double> all;
  const auto add = [&](const Eigen::MatrixXd& information, const Eigen::VectorXd& r) {
    const Eigen::VectorXd white = information.llt().matrixU() * r;
    all.insert(all.end(), white.begin(), white.end());
  };
  const StatePrior prior = start_prior(sim.drive.start, sim.drive.poses[0], noise, params);
  add(prior.information, prior.mean.step_to(states[0]));
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    const InertialState &i = states[k], &j = states[k + 1];
    const MapPose& pose = sim.drive.poses[k + 1];
    add(pose.information, (pose.T_map_body.inverse() * j.T_map_world * j.T_world_body).log());
    const SE3 drift = i.T_map_world.inverse() * j.T_map_world;
    add(sim.drive.map_drifts[k].inverse(), (i.T_world_body.inverse() * drift * i.T_world_body).log());
    const auto readings =
        preintegrate(sim.samples, sim.drive.stamps[k], sim.drive.stamps[k + 1], summed_for[k], noise);
    add(readings->covariance.inverse(), inertial_residual(states[k], states[k + 1], *readings, noise));
    const double dt = seconds_between(sim.drive.stamps[k], sim.drive.stamps[k + 1]);
    const InertialState::Tangent change = states[k].step_to(states[k + 1]);
    add(Eigen::Matrix3d::Identity() / (noise.gyroscope_walk * noise.gyroscope_walk * dt),
        change.segment<3>(InertialState::kGyroscope));
    add(Eigen::Matrix3d::Identity() / (noise.accelerometer_walk * noise.accelerometer_walk * dt),
        change.segment<3>(InertialState::kAccelerometer));
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Dense minimisation with numerical derivatives, starting from the truth.
TEST(InertialSmoother, EqualsADenseSolve) {
  const ImuNoiseParams noise;
  const InertialSmootherParams params;
  DrivePlan plan;
  plan.duration_s = 0.7;
  plan.corridor_begin_s = 0.2;
  plan.corridor_end_s = 0.4;
  const SimulatedDrive sim = simulate_drive(plan, noise, params, Rng(31));
  const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
  ASSERT_TRUE(smoothed && smoothed->converged);

  std::vector<InertialBias> summed_for;
  for (const auto& state : smoothed->states) summed_for.push_back(state.bias);
  auto states = sim.truth;
  const auto n = static_cast<Eigen::Index>(states.size());
  const auto residual = [&](const std::vector<InertialState>& at) {
    return whitened(sim, at, summed_for, noise, params);
  };
  Eigen::MatrixXd information;
  for (int round = 0; round < 6; ++round) {
    const Eigen::VectorXd r = residual(states);
    Eigen::MatrixXd jacobian(r.size(), n * kDof);
    for (Eigen::Index column = 0; column < n * kDof; ++column) {
      constexpr double h = 1e-6;
      auto up = states, down = states;
      const auto k = static_cast<std::size_t>(column / kDof);
      const InertialState::Tangent step = h * InertialState::Tangent::Unit(column % kDof);
      up[k] = up[k].moved_by(step);
      down[k] = down[k].moved_by(-step);
      jacobian.col(column) = (residual(up) - residual(down)) / (2 * h);
    }
    information = jacobian.transpose() * jacobian;
    const Eigen::VectorXd step = -information.ldlt().solve(jacobian.transpose() * r);
    for (std::size_t k = 0; k < states.size(); ++k)
      states[k] = states[k].moved_by(step.segment<kDof>(static_cast<Eigen::Index>(k) * kDof));
  }
  const Eigen::MatrixXd covariance = information.inverse();
  EXPECT_NEAR(smoothed->cost, residual(states).squaredNorm(), 1e-3);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * kDof;
    const InertialState::Jacobian block = covariance.block<kDof, kDof>(at, at);
    EXPECT_LT(squared_norm(states[k].step_to(smoothed->states[k]), block), 1e-4) << k;
    const Eigen::VectorXd scale = block.diagonal().cwiseSqrt().cwiseInverse();
    const InertialState::Jacobian difference = block - smoothed->covariance.of(k);
    EXPECT_LT((scale.asDiagonal() * difference * scale.asDiagonal()).cwiseAbs().maxCoeff(), 1e-3) << k;
  }
  const SE3::Jacobian far = covariance.block<6, 6>(kDof, 5 * kDof);
  const SE3::Jacobian between = smoothed->covariance.between(1, 5).topLeftCorner<6, 6>();
  EXPECT_TRUE(between.isApprox(far, 1e-3));
}

TEST(InertialSmoother, CovariancesAreConsistent) {
  const ImuNoiseParams noise = good_unit();
  const InertialSmootherParams params;
  constexpr int kRuns = 120;
  double middle = 0, last = 0, step = 0, half = 0;
  for (int run = 0; run < kRuns; ++run) {
    const SimulatedDrive sim =
        simulate_drive({}, noise, params, Rng(32).split(static_cast<std::uint64_t>(run)));
    const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
    ASSERT_TRUE(smoothed && smoothed->converged) << run;
    const auto nees = [&](std::size_t k) {
      return squared_norm(smoothed->states[k].step_to(sim.truth[k]), smoothed->covariance.of(k));
    };
    const auto relative = [&](std::size_t i, std::size_t j) {
      const auto estimate = smoothed->relative_pose(i, j);
      const SE3 T_i_j = sim.truth[i].T_world_body.inverse() * sim.truth[j].T_world_body;
      const SE3::Tangent error = (estimate.pose.inverse() * T_i_j).log();
      return error.dot(estimate.covariance.llt().solve(error));
    };
    middle += nees(20);
    last += nees(40);
    step += relative(20, 21);
    half += relative(10, 30);
  }
  EXPECT_TRUE(in_band(middle, InertialState::kDof * kRuns));
  EXPECT_TRUE(in_band(last, InertialState::kDof * kRuns));
  EXPECT_TRUE(in_band(step, 6 * kRuns));
  EXPECT_TRUE(in_band(half, 6 * kRuns));
}

/// Twenty seconds of a minute in a featureless corridor, where scan matching observes no motion.
TEST(InertialSmoother, BridgesACorridor) {
  const ImuNoiseParams noise;
  const InertialSmootherParams params;
  DrivePlan plan;
  plan.duration_s = 60;
  plan.corridor_begin_s = 20;
  plan.corridor_end_s = 40;
  plan.liveliness = {0.5, 0.2, 1.5, 0, 0};
  plan.course_mps = {1.2, 0, 0};
  const auto length_error = [](const SimulatedDrive& sim, const SE3& T_from_to) {
    const SE3 truth = sim.truth[190].T_world_body.inverse() * sim.truth[410].T_world_body;
    return (T_from_to.translation() - truth.translation()).norm();
  };
  for (std::uint64_t run = 0; run < 4; ++run) {
    const SimulatedDrive sim = simulate_drive(plan, noise, params, Rng(34).split(run));
    const SE3 by_scans = sim.drive.poses[190].T_map_body.inverse() * sim.drive.poses[410].T_map_body;
    const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
    ASSERT_TRUE(smoothed && smoothed->converged);
    const UncertainPose<SE3> bridged = smoothed->relative_pose(190, 410);
    const double error = length_error(sim, bridged.pose);
    EXPECT_GT(length_error(sim, by_scans), 10 * error);
    EXPECT_LT(error, 4 * std::sqrt(bridged.covariance.topLeftCorner<3, 3>().trace()));
    RecordProperty("error_m_" + std::to_string(run), std::to_string(error));
  }
}

TEST(InertialSmoother, GapsInTheReadingsLeaveTheScans) {
  const ImuNoiseParams noise;
  const InertialSmootherParams params;
  SimulatedDrive sim = simulate_drive({}, noise, params, Rng(35));
  sim.samples.erase(sim.samples.begin() + 250, sim.samples.begin() + 500);
  const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
  ASSERT_TRUE(smoothed && smoothed->converged);
  const InertialState::Tangent error = smoothed->states[20].step_to(sim.truth[20]);
  EXPECT_LT(error.head<3>().norm(), 0.5);
  // Without either, the next pose is undetermined.
  sim.drive.poses[21].information.setZero();
  EXPECT_FALSE(smooth_inertially(sim.drive, sim.samples, noise, params));
}

/// Every twentieth registration wrong by a metre or half a radian.
TEST(InertialSmoother, ToleratesWrongRegistrations) {
  const ImuNoiseParams noise = good_unit();
  const InertialSmootherParams params;
  SimulatedDrive sim = simulate_drive({}, noise, params, Rng(36));
  Rng rng(37);
  for (std::size_t k = 0; k < sim.drive.poses.size(); ++k) {
    sim.drive.poses[k].outlier_sigmas = 5;
    if (k % 20 != 10) continue;
    SE3::Tangent wrong;
    wrong << test::normal_vector(rng, 1), test::normal_vector(rng, 0.5);
    sim.drive.poses[k].T_map_body = sim.drive.poses[k].T_map_body * SE3::exp(wrong);
  }
  const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
  ASSERT_TRUE(smoothed && smoothed->converged);
  const double nees = squared_norm(smoothed->states.back().step_to(sim.truth.back()),
                                   smoothed->covariance.of(sim.truth.size() - 1));
  EXPECT_LT(nees, chi_squared_quantile(0.999, kDof));
}

TEST(InertialSmoother, OneStateIsItsPrior) {
  const ImuNoiseParams noise;
  const InertialSmootherParams params;
  InertialDrive drive;
  drive.stamps = {Stamp{0}};
  drive.poses = {{SE3(), SE3::Jacobian::Zero()}};
  const auto smoothed = smooth_inertially(drive, {}, noise, params);
  ASSERT_TRUE(smoothed);
  EXPECT_NEAR(smoothed->covariance.of(0)(6, 6), 100, 1e-9);
  EXPECT_NEAR(smoothed->covariance.of(0)(3, 3), 0.01, 1e-9);
}

}  // namespace
}  // namespace radioslam

#include "radioslam/inertial/inertial_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "inertial/simulated_drive.hpp"

namespace radioslam {
namespace {

using test::DrivePlan;
using test::simulate_drive;
using test::SimulatedDrive;
using Block = InertialState::Jacobian;

/// The filter at the end of a drive.
InertialFilter filtered(const SimulatedDrive& sim, const ImuNoiseParams& noise,
                        const InertialSmootherParams& params) {
  InertialFilter filter(start_prior(sim.drive.start, sim.drive.poses[0], noise, params));
  for (std::size_t k = 0; k + 1 < sim.drive.stamps.size(); ++k) {
    const Stamp from = sim.drive.stamps[k], to = sim.drive.stamps[k + 1];
    const auto readings = preintegrate(sim.samples, from, to, filter.state().bias, noise);
    const auto step =
        state_step(sim.drive.poses[k + 1], sim.drive.map_drifts[k], readings, seconds_between(from, to));
    EXPECT_EQ(filter.advance(step, noise), InertialFilter::Advance::kDone) << k;
  }
  return filter;
}

constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Distance of the filter's last state from the smoother's, in standard deviations, and of their covariances.
struct Difference {
  double state = 0, covariance = 0;
};

Difference from_the_smoother(const SimulatedDrive& sim, const ImuNoiseParams& noise,
                             const InertialSmootherParams& params) {
  const InertialFilter filter = filtered(sim, noise, params);
  const auto smoothed = smooth_inertially(sim.drive, sim.samples, noise, params);
  if (!smoothed || !smoothed->converged) return {kNowhere, kNowhere};
  const Block covariance = smoothed->covariance.of(sim.truth.size() - 1);
  const InertialState::Tangent off = smoothed->states.back().step_to(filter.state());
  const Eigen::LLT<Block> root(covariance);  // whitens the smoother's covariance
  const Block half = root.matrixL().solve(filter.covariance());
  const Block whitened = root.matrixL().solve(half.transpose());
  return {root.matrixL().solve(off).norm(), (whitened - Block::Identity()).cwiseAbs().maxCoeff()};
}

/// The last state depends on all measurements: filter and smoother agree on it if higher-order terms are
/// small, as with little rotation and known initial rotations and biases.
TEST(InertialFilter, EndsWhereTheSmootherEndsIfTheDriveIsNearlyLinear) {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 1e-3;
  noise.sigma_gyroscope_bias_radps = 1e-4;
  noise.gyroscope_noise = 5e-5;
  InertialSmootherParams params;
  params.sigma_start_tilt_rad = 1e-4;
  params.cost_tolerance = 1e-12;
  DrivePlan plan;
  plan.sigma_rotation_rad = 3e-4;
  plan.sigma_drift_rad = 1e-4;
  plan.liveliness = {1, 0.01, 2, 0.5, 0};
  plan.corridor_begin_s = 1.5;
  plan.corridor_end_s = 3;
  for (std::uint64_t n = 0; n < 5; ++n) {
    const auto off = from_the_smoother(simulate_drive(plan, noise, params, Rng(61).split(n)), noise, params);
    EXPECT_LT(off.state, 0.05) << n;  // the map's drift along the corridor rotates with the body
    EXPECT_LT(off.covariance, 0.02) << n;
  }
}

/// With two states only, both solve the same least squares, for any initial tilt.
TEST(InertialFilter, TakesOneStepAsTheSmootherDoes) {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 1e-3;
  noise.sigma_gyroscope_bias_radps = 1e-4;
  InertialSmootherParams params;
  params.sigma_start_tilt_rad = 0.2;
  params.cost_tolerance = 1e-12;
  DrivePlan plan;
  plan.duration_s = 1;
  plan.states_hz = 1;
  for (std::uint64_t n = 0; n < 5; ++n) {
    const auto off = from_the_smoother(simulate_drive(plan, noise, params, Rng(64).split(n)), noise, params);
    EXPECT_LT(off.state, 1e-4) << n;
    EXPECT_LT(off.covariance, 0.1) << n;
  }
}

/// With rotation and unknown biases the two differ by higher-order terms.
TEST(InertialFilter, EndsNearTheSmootherOnALivelyDrive) {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 0.05;
  InertialSmootherParams params;
  params.sigma_start_tilt_rad = 0.02;
  const auto off = from_the_smoother(simulate_drive({}, noise, params, Rng(33)), noise, params);
  EXPECT_LT(off.state, 1);
  EXPECT_LT(off.covariance, 0.3);
}

/// Scans that observe rotation only, never the position on the map.
TEST(InertialFilter, ContinuesIfTheFirstPoseDoesNotObserveTheMap) {
  const ImuNoiseParams noise;
  const InertialSmootherParams params;
  SimulatedDrive sim = simulate_drive({}, noise, params, Rng(65));
  for (MapPose& pose : sim.drive.poses) {
    pose.information.topRows<3>().setZero();
    pose.information.leftCols<3>().setZero();
  }
  const InertialFilter filter = filtered(sim, noise, params);  // expects every step to succeed
  EXPECT_TRUE(filter.covariance().allFinite());
}

StatePrior drawn_belief(Rng& rng) {
  InertialState state = test::SmoothMotion(rng.split("motion"), {}).state(1);
  const MapPose pose{SE3({1, 2, 3}, so3_exp({0.3, 0.1, -1})) * state.T_world_body,
                     1e4 * SE3::Jacobian::Identity()};
  StatePrior prior = start_prior(state, pose, {}, {});
  Block mixing = Block::Identity();
  for (Eigen::Index k = 0; k < mixing.size(); ++k) mixing(k) += rng.normal(0, 0.05);
  prior.information = (mixing.transpose() * prior.information * mixing).eval();
  return prior;
}

/// Without IMU samples the pose follows from the map pose, T_j = M_j^-1 Z; velocity and biases perform random
/// walks.
TEST(InertialFilter, WithoutReadingsTakesThePoseFromTheMap) {
  const ImuNoiseParams noise;
  Rng rng(62);
  const StatePrior start = drawn_belief(rng);
  SE3::Tangent motion;
  motion << 1, 0.2, 0, 0, 0.1, 0.5;
  SE3::Jacobian of_pose = SE3::Jacobian::Identity() * 1e-4, of_drift = SE3::Jacobian::Identity() * 1e-5;
  of_pose(0, 5) = of_pose(5, 0) = 5e-5;
  of_drift(1, 3) = of_drift(3, 1) = 5e-6;
  InertialFilter filter(start);
  const Block before = filter.covariance();
  const double duration_s = 0.5;
  InertialState there = start.mean;
  there.T_world_body = there.T_world_body * SE3::exp(motion);
  const MapPose pose{there.T_map_world * there.T_world_body, of_pose.inverse()};
  const auto step = state_step(pose, of_drift, std::nullopt, duration_s);
  ASSERT_EQ(filter.advance(step, noise), InertialFilter::Advance::kDone);

  constexpr int kMap = InertialState::kMap;
  Block carry = Block::Identity(), expected = Block::Zero();
  carry.topLeftCorner<6, 6>().setZero();
  carry.block<6, 6>(0, kMap) = -there.T_world_body.inverse().adjoint();
  const auto walk = [&](int at, double density) {
    expected.block<3, 3>(at, at).diagonal().setConstant(density * density * duration_s);
  };
  walk(InertialState::kVelocity, noise.unmeasured_velocity_walk);
  walk(InertialState::kGyroscope, noise.gyroscope_walk);
  walk(InertialState::kAccelerometer, noise.accelerometer_walk);
  const SE3::Jacobian of_body = start.mean.T_world_body.adjoint();
  expected.block<6, 6>(kMap, kMap) = of_body * of_drift * of_body.transpose();
  expected = (carry * (expected + before) * carry.transpose()).eval();
  expected.topLeftCorner<6, 6>() += of_pose;
  const InertialState::Tangent scale = expected.diagonal().cwiseSqrt().cwiseInverse();
  const Block off = scale.asDiagonal() * (filter.covariance() - expected) * scale.asDiagonal();
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(there.step_to(filter.state()).norm(), 1e-9);
}

TEST(InertialFilter, RefusesUndeterminedStepsAndKeepsItsState) {
  const ImuNoiseParams noise;
  Rng rng(63);
  InertialFilter filter(drawn_belief(rng));
  const InertialState before = filter.state();
  const Block information = filter.belief().information;
  SE3::Jacobian no_x = SE3::Jacobian::Identity();
  no_x(0, 0) = 0;
  for (const SE3::Jacobian& known : {SE3::Jacobian(SE3::Jacobian::Zero()), no_x})
    EXPECT_EQ(filter.advance(state_step({SE3(), known}, SE3::Jacobian::Identity(), std::nullopt, 0.1), noise),
              InertialFilter::Advance::kUndetermined);
  EXPECT_EQ(filter.state().T_world_body.translation(), before.T_world_body.translation());
  EXPECT_EQ(filter.state().velocity_mps, before.velocity_mps);
  EXPECT_EQ(filter.belief().information, information);
}

}  // namespace
}  // namespace radioslam

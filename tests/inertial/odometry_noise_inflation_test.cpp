#include "radioslam/inertial/odometry_noise_inflation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "inertial/simulated_drive.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

/// The smoothed states as odometry with noise, as used by the joint graph.
struct SmoothedOdometry {
  test::SimulatedDrive sim;
  Trajectory<SE3> rows;
  OdometryNoise noise;
  InertialTrajectory states;
};

SmoothedOdometry smoothed_odometry(const test::DrivePlan& plan, std::uint64_t run) {
  ImuNoiseParams unit;
  unit.sigma_accelerometer_bias_mps2 = 0.05;
  const InertialSmootherParams params;
  auto sim = test::simulate_drive(plan, unit, params, Rng(41).split(run));
  auto states = *smooth_inertially(sim.drive, sim.samples, unit, params);
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < states.stamps.size(); ++k)
    rows.push_back({states.stamps[k], states.states[k].T_world_body});
  OdometryNoise noise;
  noise.steps = odometry_noise_inflation(states, {});
  return {std::move(sim), Trajectory<SE3>(std::move(rows)), std::move(noise), std::move(states)};
}

/// Squared error of an edge, normalised by its stated noise, per dimension.
double edge_nees(const SmoothedOdometry& odometry, std::size_t i, std::size_t j) {
  const auto edge = odometry_edge<SE3>(odometry.rows, i, j, odometry.noise);
  const auto& truth = odometry.sim.truth;
  const SE3 T_i_j = truth[i].T_world_body.inverse() * truth[j].T_world_body;
  const SE3::Tangent error = (edge.T_i_j.inverse() * T_i_j).log();
  return error.dot(edge.covariance.llt().solve(error)) / SE3::kDof;
}

/// The same with the single-step noise only, not inflated.
SmoothedOdometry with_noise_of_single_steps(SmoothedOdometry odometry) {
  auto& steps = odometry.noise.steps;
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k].covariance_per_s =
        odometry.states.relative_pose(k, k + 1).covariance / seconds_between(steps[k].begin, steps[k].end);
  return odometry;
}

/// For spans from a tenth of a second to the whole drive: on average neither overconfident nor useless.
TEST(OdometryNoiseOfStates, HoldsOverEverySpan) {
  test::DrivePlan plan;
  plan.duration_s = 12;
  constexpr int kRuns = 25;
  std::vector<SmoothedOdometry> runs;
  for (std::uint64_t run = 0; run < kRuns; ++run) runs.push_back(smoothed_odometry(plan, run));
  for (const std::size_t span : {1U, 10U, 37U, 120U}) {
    double sum = 0;
    int edges = 0;
    for (const SmoothedOdometry& odometry : runs)
      for (std::size_t i = 0; i + span <= 120; i += std::max<std::size_t>(span, 20), ++edges)
        sum += edge_nees(odometry, i, i + span);
    RecordProperty("nees_" + std::to_string(span), std::to_string(sum / edges));
    EXPECT_LT(sum / edges, 1.25) << span;
    EXPECT_GT(sum / edges, 0.04) << span;
  }
}

TEST(OdometryNoiseOfStates, SingleStepsWouldBeOverconfident) {
  test::DrivePlan plan;
  plan.duration_s = 12;
  double sum = 0;
  constexpr int kRuns = 5;
  for (std::uint64_t run = 0; run < kRuns; ++run)
    sum += edge_nees(with_noise_of_single_steps(smoothed_odometry(plan, run)), 0, 120) / kRuns;
  RecordProperty("nees", std::to_string(sum));
  EXPECT_GT(sum, 3);
}

TEST(OdometryNoiseOfStates, AddsUpToTheJointCovarianceAtLeast) {
  test::DrivePlan plan;
  plan.duration_s = 13;
  plan.corridor_begin_s = 3;
  plan.corridor_end_s = 9;
  const auto odometry = smoothed_odometry(plan, 0);
  for (const std::size_t span : {1U, 2U, 16U, 64U, 128U})
    for (std::size_t i = 0; i + span <= 130; i += span) {
      const auto edge = odometry_edge<SE3>(odometry.rows, i, i + span, odometry.noise);
      const SE3::Jacobian joint = odometry.states.relative_pose(i, i + span).covariance;
      const Eigen::LLT<SE3::Jacobian> larger(edge.covariance - 0.999 * joint);
      EXPECT_EQ(larger.info(), Eigen::Success) << i << " + " << span;
    }
}

}  // namespace
}  // namespace radioslam

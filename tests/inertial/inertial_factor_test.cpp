#include "radioslam/inertial/inertial_factor.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"
#include "radioslam/inertial/motion_prediction.hpp"

namespace radioslam {
namespace {

InertialState drawn_state(Rng& rng) {
  SE3::Tangent pose;
  pose << test::normal_vector(rng, 2), test::normal_vector(rng, 1);
  return {SE3::exp(pose),
          test::normal_vector(rng, 2),
          {test::normal_vector(rng, 0.02), test::normal_vector(rng, 0.2)}};
}

InertialState::Tangent drawn_step(Rng& rng, double size) {
  InertialState::Tangent step;
  for (int k = 0; k < InertialState::kDof; ++k) step[k] = rng.normal(0, size);
  return step;
}

TEST(InertialFactor, JacobiansEqualNumericalOnes) {
  const InertialNoiseParams params;
  Rng rng(1);
  for (int n = 0; n < 30; ++n) {
    const test::SmoothMotion motion(rng.split(static_cast<std::uint64_t>(n)), {});
    const InertialBias bias{test::normal_vector(rng, 0.02), test::normal_vector(rng, 0.2)};
    const auto measured = *preintegrate(test::perfect_readings(motion, 1, 100, params), Stamp{0},
                                        Stamp::from_seconds(0.7), bias, params);
    const InertialState i = drawn_state(rng);
    const InertialState j = state_after(i, measured.motion, params).moved_by(drawn_step(rng, 0.3));
    const auto linear = linearise_inertial(i, j, measured, params);
    EXPECT_TRUE(linear.residual.isApprox(inertial_residual(i, j, measured, params)));
    for (int axis = 0; axis < InertialState::kDof; ++axis) {
      constexpr double h = 1e-5;
      const InertialState::Tangent step = h * InertialState::Tangent::Unit(axis);
      const InertialResidual by_i = (inertial_residual(i.moved_by(step), j, measured, params) -
                                     inertial_residual(i.moved_by(-step), j, measured, params)) /
                                    (2 * h);
      const InertialResidual by_j = (inertial_residual(i, j.moved_by(step), measured, params) -
                                     inertial_residual(i, j.moved_by(-step), measured, params)) /
                                    (2 * h);
      EXPECT_LT((linear.by_i.col(axis) - by_i).norm(), 2e-7) << axis;
      EXPECT_LT((linear.by_j.col(axis) - by_j).norm(), 2e-7) << axis;
    }
  }
}

TEST(InertialFactor, IsZeroAtThePredictedState) {
  const InertialNoiseParams params;
  Rng rng(2);
  const test::SmoothMotion motion(Rng(3), {});
  const auto samples = test::perfect_readings(motion, 2, 100, params);
  const InertialState i = drawn_state(rng);
  const Stamp from = Stamp::from_seconds(0.333), to = Stamp::from_seconds(1.234);
  const auto measured = *preintegrate(samples, from, to, i.bias, params);
  const auto j = predict_motion(i, from, samples, {to}, params);
  ASSERT_TRUE(j);
  EXPECT_LT(inertial_residual(i, j->front(), measured, params).norm(), 1e-12);
}

TEST(InertialState, MovesByTheStepBetween) {
  Rng rng(4);
  const InertialState a = drawn_state(rng), b = drawn_state(rng);
  EXPECT_LT(a.moved_by(a.step_to(b)).step_to(b).norm(), 1e-12);
}

/// 200 Hz within a scan, off the readings' stamps.
TEST(MotionPrediction, FollowsTheMotion) {
  const InertialNoiseParams params;
  for (int n = 0; n < 10; ++n) {
    const test::SmoothMotion motion(Rng(5).split(static_cast<std::uint64_t>(n)), {});
    const auto samples = test::perfect_readings(motion, 2, 200, params);
    std::vector<Stamp> stamps;
    for (int k = 0; k <= 20; ++k) stamps.push_back(Stamp::from_seconds(1.0021 + 0.005 * k));
    const auto states = predict_motion(motion.state(1), Stamp::from_seconds(1), samples, stamps, params);
    ASSERT_TRUE(states);
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      const auto error = motion.state(stamps[k].seconds()).step_to((*states)[k]);
      EXPECT_LT(error.norm(), 3e-4);
    }
  }
}

TEST(MotionPrediction, RefusesGaps) {
  const InertialNoiseParams params;
  const test::SmoothMotion motion(Rng(6), {});
  const auto samples = test::perfect_readings(motion, 1, 100, params);
  EXPECT_FALSE(predict_motion({}, Stamp::from_seconds(0.9), samples, {Stamp::from_seconds(1.2)}, params));
  const auto none = predict_motion({}, Stamp{0}, samples, {}, params);
  EXPECT_TRUE(none && none->empty());
}

}  // namespace
}  // namespace radioslam

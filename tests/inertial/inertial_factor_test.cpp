#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"
#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/inertial/state_factors.hpp"

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
  const ImuNoiseParams params;
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
  const ImuNoiseParams params;
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

}  // namespace
}  // namespace radioslam

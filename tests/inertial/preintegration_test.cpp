#include "radioslam/inertial/preintegration.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/state_factors.hpp"

namespace radioslam {
namespace {

using test::Liveliness;
using test::SmoothMotion;

ImuNoiseParams quiet_unit() {
  ImuNoiseParams params;
  params.integration_noise = 1e-8;
  return params;
}

/// [position, rotation, velocity] from one free motion to another.
InertialResidual between(const FreeMotion& a, const FreeMotion& b) {
  InertialResidual r;
  r << b.position_m - a.position_m, so3_log(a.rotation.conjugate() * b.rotation),
      b.velocity_mps - a.velocity_mps;
  return r;
}

/// The known poses and velocities of a motion leave no residual, up to the square of the sampling interval.
TEST(Preintegration, IsTheMotionItself) {
  const ImuNoiseParams params;
  for (int n = 0; n < 20; ++n) {
    const SmoothMotion motion(Rng(4).split(static_cast<std::uint64_t>(n)), Liveliness{});
    const auto error = [&](double rate_hz) {
      const auto sum = preintegrate(test::perfect_readings(motion, 2.5, rate_hz, params),
                                    Stamp::from_seconds(0.5133), Stamp::from_seconds(1.9077), {}, params);
      return inertial_residual(motion.state(0.5133), motion.state(1.9077), *sum, params).norm();
    };
    const double at_200_hz = error(200), at_2000_hz = error(2000);
    EXPECT_LT(at_200_hz, 2e-3) << n;
    EXPECT_LT(at_2000_hz, 2e-5) << n;
  }
}

/// Relative to free fall, a body at rest accelerates upwards.
TEST(Preintegration, AtRestByHand) {
  ImuNoiseParams params;
  params.gravity_mps2 = 10;
  std::vector<ImuSample> samples;
  for (int k = 0; k <= 100; ++k) samples.push_back({Stamp::from_seconds(0.01 * k), {0, 0, 10}, {0, 0, 0}});
  const auto sum = preintegrate(samples, Stamp{0}, Stamp::from_seconds(1), {}, params);
  ASSERT_TRUE(sum);
  EXPECT_TRUE(sum->motion.position_m.isApprox(Eigen::Vector3d(0, 0, 5)));
  EXPECT_TRUE(sum->motion.velocity_mps.isApprox(Eigen::Vector3d(0, 0, 10)));
  EXPECT_NEAR(so3_log(sum->motion.rotation).norm(), 0, 1e-15);
  // White noise of density s: velocity s^2 t, position s^2 t^3 / 3, rotation s_g^2 t.
  EXPECT_NEAR(sum->covariance(8, 8), 25e-6, 1e-9);
  EXPECT_NEAR(sum->covariance(2, 2), 25e-6 / 3 + 1e-8, 1e-9);
  EXPECT_NEAR(sum->covariance(5, 5), 25e-8, 1e-12);
  // Tilt from gyroscope noise adds horizontal acceleration by gravity: 100 s_g^2 t^3 / 3.
  EXPECT_NEAR(sum->covariance(6, 6), 25e-6 + 25e-6 / 3, 1e-8);
}

TEST(Preintegration, BiasJacobianEqualsTheNumericalOne) {
  const ImuNoiseParams params;
  Rng rng(5);
  for (int n = 0; n < 10; ++n) {
    const SmoothMotion motion(rng.split(static_cast<std::uint64_t>(n)), Liveliness{});
    const auto samples = test::perfect_readings(motion, 1, 100, params);
    const auto sum_with = [&](const Eigen::Matrix<double, 6, 1>& bias) {
      return *preintegrate(samples, Stamp::from_seconds(0.1), Stamp::from_seconds(0.95),
                           {bias.head<3>(), bias.tail<3>()}, params);
    };
    Eigen::Matrix<double, 6, 1> bias;
    bias << test::normal_vector(rng, 0.02), test::normal_vector(rng, 0.2);
    const Preintegration sum = sum_with(bias);
    for (int axis = 0; axis < 6; ++axis) {
      constexpr double h = 1e-5;
      const Eigen::Matrix<double, 6, 1> step = h * Eigen::Matrix<double, 6, 1>::Unit(axis);
      const auto up = sum_with(bias + step), down = sum_with(bias - step);
      const InertialResidual numerical =
          (between(sum.motion, up.motion) - between(sum.motion, down.motion)) / (2 * h);
      EXPECT_LT((sum.bias_jacobian.col(axis) - numerical).norm(), 1e-7) << axis;
    }
  }
}

/// The first order is accurate for realistic biases: one hundredth of the change is left.
TEST(Preintegration, FollowsAChangedBias) {
  const ImuNoiseParams params;
  const SmoothMotion motion(Rng(6), Liveliness{});
  const auto samples = test::perfect_readings(motion, 1, 200, params);
  const InertialBias bias{{0.01, -0.02, 0.015}, {0.1, 0.2, -0.15}};
  const auto without = *preintegrate(samples, Stamp{0}, Stamp::from_seconds(1), {}, params);
  const auto with = *preintegrate(samples, Stamp{0}, Stamp::from_seconds(1), bias, params);
  const double change = between(without.motion, with.motion).norm();
  EXPECT_LT(between(without.with_bias(bias), with.motion).norm(), 0.02 * change);
  EXPECT_LT(between(with.with_bias({}), without.motion).norm(), 0.02 * change);
}

TEST(Preintegration, CovarianceIsThatOfManyUnits) {
  const ImuNoiseParams params = quiet_unit();
  const SmoothMotion motion(Rng(7), Liveliness{});
  const auto clean = test::perfect_readings(motion, 0.5, 200, params);
  const Stamp end = Stamp::from_seconds(0.5);
  const Preintegration truth = *preintegrate(clean, Stamp{0}, end, {}, params);
  const Preintegration::Covariance information = truth.covariance.inverse();
  constexpr int kUnits = 1500;
  Preintegration::Covariance seen = Preintegration::Covariance::Zero();
  double squared_norm = 0;
  ImuNoiseParams white = params;
  white.accelerometer_walk = white.gyroscope_walk = 0;
  Rng rng(8);
  for (int n = 0; n < kUnits; ++n) {
    auto samples = clean;
    test::add_errors(samples, {}, 200, white, rng);
    const auto sum = preintegrate(samples, Stamp{0}, end, {}, params);
    const InertialResidual error = between(truth.motion, sum->motion);
    seen += error * error.transpose() / kUnits;
    squared_norm += error.dot(information * error) / kUnits;
  }
  EXPECT_NEAR(squared_norm, 9, 3 * std::sqrt(18.0 / kUnits));
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(seen(k, k) / truth.covariance(k, k), 1, 0.12) << k;
}

TEST(Preintegration, OfTwoPartsIsThatOfTheWhole) {
  const ImuNoiseParams params;
  const SmoothMotion motion(Rng(9), Liveliness{});
  const auto samples = test::perfect_readings(motion, 1, 100, params);
  const Stamp middle = Stamp::from_seconds(0.4), end = Stamp::from_seconds(0.9);
  FreeMotion first = preintegrate(samples, Stamp{0}, middle, {}, params)->motion;
  const FreeMotion second = preintegrate(samples, middle, end, {}, params)->motion;
  const FreeMotion whole = preintegrate(samples, Stamp{0}, end, {}, params)->motion;
  first.position_m += second.duration_s * first.velocity_mps + first.rotation * second.position_m;
  first.velocity_mps += first.rotation * second.velocity_mps;
  first.rotation = first.rotation * second.rotation;
  EXPECT_LT(between(first, whole).norm(), 1e-12);
}

TEST(Preintegration, RefusesGaps) {
  const ImuNoiseParams params;
  const SmoothMotion motion(Rng(10), Liveliness{});
  auto samples = test::perfect_readings(motion, 2, 100, params);
  const auto sum = [&](double from, double to) {
    return preintegrate(samples, Stamp::from_seconds(from), Stamp::from_seconds(to), {}, params);
  };
  EXPECT_TRUE(sum(-0.05, 2.05));
  EXPECT_FALSE(sum(-0.15, 1));
  EXPECT_FALSE(sum(1, 2.15));
  samples.erase(samples.begin() + 100, samples.begin() + 115);
  EXPECT_TRUE(sum(0, 0.99));
  EXPECT_FALSE(sum(0, 1.05));
  EXPECT_FALSE(sum(0.5, 1.5));
  EXPECT_FALSE(sum(1.05, 1.1));
  EXPECT_TRUE(sum(1.16, 2));
  samples.clear();
  EXPECT_FALSE(sum(0, 1));
}

}  // namespace
}  // namespace radioslam

#include <gtest/gtest.h>

#include <numbers>

#include "inertial/smooth_motion.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

/// A constant sample at 100 Hz until `end_s`.
std::vector<ImuSample> steady_readings(const Eigen::Vector3d& force_mps2, const Eigen::Vector3d& rate_radps,
                                       double end_s) {
  std::vector<ImuSample> samples;
  for (int k = 0; k <= std::lround(100 * end_s); ++k)
    samples.push_back({Stamp::from_seconds(0.01 * k), force_mps2, rate_radps});
  return samples;
}

std::vector<Stamp> every_tenth(double begin_s, double end_s) {
  std::vector<Stamp> stamps;
  for (long k = std::lround(10 * begin_s); k <= std::lround(10 * end_s); ++k)
    stamps.push_back(Stamp::from_seconds(0.1 * static_cast<double>(k)));
  return stamps;
}

/// Predicted at 200 Hz within a scan, between the samples' stamps.
TEST(MotionPrediction, FollowsTheMotion) {
  const ImuNoiseParams params;
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

/// A thrown body, which tumbles without any specific force.
TEST(MotionPrediction, OfAThrowIsAParabola) {
  const ImuNoiseParams params;
  InertialState start;
  start.T_world_body = SE3({1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY())));
  start.velocity_mps = {2, -1, 5};
  const auto stamps = every_tenth(0, 1);
  const auto states =
      predict_motion(start, Stamp{0}, steady_readings({0, 0, 0}, {0, 3, 0}, 1), stamps, params);
  ASSERT_TRUE(states);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const double t = stamps[k].seconds();
    const Eigen::Vector3d position(1 + 2 * t, 2 - t, 3 + 5 * t - 9.81 * t * t / 2);
    EXPECT_LT(((*states)[k].T_world_body.translation() - position).norm(), 1e-9);
    EXPECT_LT(((*states)[k].velocity_mps - Eigen::Vector3d(2, -1, 5 - 9.81 * t)).norm(), 1e-9);
    const Eigen::AngleAxisd turned(0.4 + 3 * t, Eigen::Vector3d::UnitY());
    EXPECT_LT(Eigen::Quaterniond(turned).angularDistance((*states)[k].T_world_body.rotation()), 1e-9);
  }
}

/// A car on a circle of 5 m at 4 m/s, accelerated to its left by v^2 / r, returns after 2 pi r / v seconds.
TEST(MotionPrediction, ClosesACircle) {
  constexpr double kRadius_m = 5, kSpeed_mps = 4, kLap_s = 2 * std::numbers::pi * kRadius_m / kSpeed_mps;
  const ImuNoiseParams params;
  InertialState start;
  start.velocity_mps = {kSpeed_mps, 0, 0};
  const auto samples = steady_readings({0, kSpeed_mps * kSpeed_mps / kRadius_m, params.gravity_mps2},
                                       {0, 0, kSpeed_mps / kRadius_m}, kLap_s + 0.1);
  const auto states = predict_motion(start, Stamp{0}, samples,
                                     {Stamp::from_seconds(kLap_s / 2), Stamp::from_seconds(kLap_s)}, params);
  ASSERT_TRUE(states);
  const Eigen::Vector3d across(0, 2 * kRadius_m, 0);
  EXPECT_LT((states->front().T_world_body.translation() - across).norm(), 1e-3);
  EXPECT_LT((states->front().velocity_mps + start.velocity_mps).norm(), 1e-3);
  EXPECT_LT(start.step_to(states->back()).norm(), 2e-3);
}

/// Biases are subtracted from the samples.
TEST(MotionPrediction, KnowsTheBiases) {
  const ImuNoiseParams params;
  const test::SmoothMotion motion(Rng(7), {});
  const auto clean = test::perfect_readings(motion, 1, 200, params);
  const InertialBias bias{{0.02, -0.01, 0.03}, {0.1, 0.2, -0.3}};
  auto biased = clean;
  for (auto& sample : biased) {
    sample.angular_rate_radps += bias.gyroscope_radps;
    sample.specific_force_mps2 += bias.accelerometer_mps2;
  }
  const auto stamps = every_tenth(0, 1);
  InertialState start = motion.state(0);
  const auto expected = predict_motion(start, Stamp{0}, clean, stamps, params);
  start.bias = bias;
  const auto states = predict_motion(start, Stamp{0}, biased, stamps, params);
  ASSERT_TRUE(expected && states);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const InertialState::Tangent off = (*expected)[k].step_to((*states)[k]);
    EXPECT_LT(off.head<9>().norm(), 1e-9);
    EXPECT_EQ((*states)[k].bias.gyroscope_radps, bias.gyroscope_radps);
    EXPECT_EQ((*states)[k].bias.accelerometer_mps2, bias.accelerometer_mps2);
  }
}

/// Prediction from an intermediate state continues the same motion.
TEST(MotionPrediction, GoesOnFromAnyOfItsStates) {
  const ImuNoiseParams params;
  const test::SmoothMotion motion(Rng(8), {});
  const auto samples = test::perfect_readings(motion, 2, 100, params);
  const auto whole = predict_motion(motion.state(0), Stamp{0}, samples, every_tenth(0, 2), params);
  ASSERT_TRUE(whole);
  const auto rest =
      predict_motion((*whole)[9], Stamp::from_seconds(0.9), samples, every_tenth(0.9, 2), params);
  ASSERT_TRUE(rest);
  for (std::size_t k = 0; k < rest->size(); ++k) EXPECT_LT((*whole)[9 + k].step_to((*rest)[k]).norm(), 1e-9);
}

TEST(MotionPrediction, RefusesGaps) {
  const ImuNoiseParams params;
  const test::SmoothMotion motion(Rng(6), {});
  const auto samples = test::perfect_readings(motion, 1, 100, params);
  EXPECT_FALSE(predict_motion({}, Stamp::from_seconds(0.9), samples, {Stamp::from_seconds(1.2)}, params));
  const auto none = predict_motion({}, Stamp{0}, samples, {}, params);
  EXPECT_TRUE(none && none->empty());
}

TEST(MotionPredictionDeathTest, RunsForward) {
  const auto samples = steady_readings({0, 0, 9.81}, {0, 0, 0}, 1);
  EXPECT_DEATH(predict_motion({}, Stamp::from_seconds(0.5), samples, {Stamp{0}}, {}), "do not decrease");
}

}  // namespace
}  // namespace radioslam

// IMU samples against an independent integrator, and their noise against the stated one.
#include "radioslam/sim/sensors/inertial_unit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/sim/motion/smooth_motion.hpp"

namespace radioslam {
namespace {

/// No noise at all.
InertialUnitParams exact_unit(double rate_hz) {
  InertialUnitParams params;
  params.imu_hz = rate_hz;
  params.imu_accelerometer_density = params.imu_gyroscope_density = 0;
  params.imu_accelerometer_bias_mps2 = params.imu_gyroscope_bias_radps = 0;
  params.imu_accelerometer_walk = params.imu_gyroscope_walk = 0;
  return params;
}

/// Up and down, left and right, turning and swaying; from rest.
TrueMotion curvy_motion() {
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k <= 300; ++k) {
    const double s = 0.1 * k;
    const SE3 level({1.5 * s, 2 * std::sin(0.4 * s), 0.3 * std::sin(0.7 * s)},
                    Eigen::Quaterniond::Identity());
    poses.push_back({Stamp::from_seconds(s), level * lift(SE2({0, 0}, 0.5 * std::cos(0.4 * s)))});
  }
  SmoothMotionParams ride;
  ride.rest_s = 1;
  ride.speed_swing = 0.4;
  ride.sway_rad = 0.05;
  return TrueMotion(smooth_motion(Trajectory<SE3>(std::move(poses)), ride, Rng(6)));
}

TrueMotion unit_at_rest(double seconds) {
  const auto controls = static_cast<std::size_t>(seconds) + 3;
  return TrueMotion(SplineMotion(std::vector<SE3>(controls), 1));
}

TEST(InertialUnit, AtRestItFeelsTheGroundPushItUp) {
  const auto samples = simulate_inertial(unit_at_rest(2), exact_unit(200), Rng(1));
  ASSERT_EQ(samples.size(), 401U);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(samples[k].stamp.ns, static_cast<std::int64_t>(k) * 5000000);
    EXPECT_LT((samples[k].specific_force_mps2 - Eigen::Vector3d(0, 0, 9.80665)).norm(), 1e-12);
    EXPECT_EQ(samples[k].angular_rate_radps.norm(), 0);
  }
  EXPECT_TRUE(simulate_inertial(unit_at_rest(2), InertialUnitParams{}, Rng(1)).empty());
}

/// Samples integrated twice by the midpoint rule, attitude as a rotation matrix.
struct Integrated {
  Eigen::Matrix3d R;
  Eigen::Vector3d velocity, position;

  void over(const ImuSample& a, const ImuSample& b) {
    const double step_s = seconds_between(a.stamp, b.stamp);
    const Eigen::Vector3d rate = 0.5 * (a.angular_rate_radps + b.angular_rate_radps);
    const Eigen::Vector3d gravity(0, 0, -9.80665);
    const Eigen::Matrix3d later = R * Eigen::AngleAxisd(step_s * rate.norm(), rate.stableNormalized());
    const Eigen::Vector3d before = R * a.specific_force_mps2 + gravity,
                          after = later * b.specific_force_mps2 + gravity;
    position += step_s * velocity + step_s * step_s * (before / 3 + after / 6);
    velocity += 0.5 * step_s * (before + after);
    R = later;
  }
};

TEST(InertialUnit, IntegratedTwiceItIsTheTrueMotion) {
  const TrueMotion motion = curvy_motion();
  const auto samples = simulate_inertial(motion, exact_unit(200), Rng(1));
  for (const std::size_t begin : {std::size_t{0}, std::size_t{2000}}) {
    const MotionState start = motion.state_at(samples[begin].stamp);
    Integrated guess{start.T_common_body.rotation_matrix(), start.velocity_mps,
                     start.T_common_body.translation()};
    for (std::size_t k = begin; k < begin + 2000; ++k) guess.over(samples[k], samples[k + 1]);
    const MotionState end = motion.state_at(samples[begin + 2000].stamp);
    EXPECT_LT((guess.position - end.T_common_body.translation()).norm(), 2e-3);
    EXPECT_LT((guess.velocity - end.velocity_mps).norm(), 1e-3);
    EXPECT_LT((guess.R - end.T_common_body.rotation_matrix()).norm(), 1e-4);
  }
}

TEST(InertialUnit, ItsNoiseIsAsStated) {
  InertialUnitParams params = exact_unit(100);
  params.imu_accelerometer_density = 0.02;
  params.imu_gyroscope_density = 0.003;
  const auto samples = simulate_inertial(unit_at_rest(100), params, Rng(2));
  double force = 0, rate = 0, neighbours = 0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const auto& sample : samples) {
    const Eigen::Vector3d noise = sample.specific_force_mps2 - Eigen::Vector3d(0, 0, kStandardGravity_mps2);
    force += noise.squaredNorm();
    rate += sample.angular_rate_radps.squaredNorm();
    neighbours += noise.dot(before);
    before = noise;
  }
  const double count = 3.0 * static_cast<double>(samples.size()), spread = 4 * std::sqrt(2 / count);
  EXPECT_NEAR(force / count / (0.02 * 0.02 * 100), 1, spread);
  EXPECT_NEAR(rate / count / (0.003 * 0.003 * 100), 1, spread);
  EXPECT_NEAR(neighbours / force, 0, 4 / std::sqrt(count)) << "white";
}

TEST(InertialUnit, ItsBiasStartsAtRandomAndIsARandomWalk) {
  InertialUnitParams params = exact_unit(20);
  params.imu_accelerometer_bias_mps2 = 0.1;
  params.imu_gyroscope_walk = 0.01;
  double biases = 0, walks = 0;
  constexpr int kUnits = 300;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto samples = simulate_inertial(unit_at_rest(16), params, Rng(seed));
    const Eigen::Vector3d bias =
        samples[0].specific_force_mps2 - Eigen::Vector3d(0, 0, kStandardGravity_mps2);
    EXPECT_LT((samples[0].specific_force_mps2 - samples.back().specific_force_mps2).norm(), 1e-12);
    EXPECT_EQ(samples[0].angular_rate_radps.norm(), 0);
    biases += bias.squaredNorm();
    walks += samples.back().angular_rate_radps.squaredNorm();
  }
  const double spread = 4 * std::sqrt(2.0 / (3 * kUnits));
  EXPECT_NEAR(biases / (3 * kUnits) / 0.01, 1, spread);
  EXPECT_NEAR(walks / (3 * kUnits) / (1e-4 * 16), 1, spread);
}

}  // namespace
}  // namespace radioslam

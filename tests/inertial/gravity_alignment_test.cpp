#include "radioslam/inertial/gravity_alignment.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kSigmaPosition_m = 0.01, kSigmaRotation_rad = 0.002;

/// Poses at 10 Hz as measured by an odometry: in a tilted frame of its own, with small errors.
Trajectory<SE3> leaning_odometry(const test::SmoothMotion& motion, const SE3& T_odometry_world, double end_s,
                                 Rng& rng) {
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; 0.1 * k <= end_s; ++k) {
    SE3::Tangent error;
    error << test::normal_vector(rng, kSigmaPosition_m), test::normal_vector(rng, kSigmaRotation_rad);
    rows.push_back({Stamp::from_seconds(0.1 * k), T_odometry_world * motion.pose(0.1 * k) * SE3::exp(error)});
  }
  return Trajectory<SE3>(std::move(rows));
}

/// Angle between the true and the estimated vertical.
double tilt_error(const GravityAlignment& found, const SE3& T_odometry_world) {
  const Eigen::Vector3d up = found.R_world_odometry * T_odometry_world.rotate(Eigen::Vector3d::UnitZ());
  return std::atan2(up.head<2>().norm(), up.z());
}

struct Start {
  test::SmoothMotion motion;
  InertialBias bias;
  SE3 T_odometry_world;
  std::vector<ImuSample> samples;
  Trajectory<SE3> odometry;
};

Start drawn_start(std::uint64_t seed, const test::Liveliness& liveliness, const ImuNoiseParams& noise) {
  Rng rng = Rng(21).split(seed);
  SE3::Tangent frame;
  frame << test::normal_vector(rng, 1), test::normal_vector(rng, 0.6);
  Start start{test::SmoothMotion(rng.split("motion"), liveliness),
              {test::normal_vector(rng, 0.01), test::normal_vector(rng, 0.05)},
              SE3::exp(frame),
              {},
              {}};
  start.samples = test::perfect_readings(start.motion, 4, 200, noise);
  test::add_errors(start.samples, start.bias, 200, noise, rng);
  start.odometry = leaning_odometry(start.motion, start.T_odometry_world, 4, rng);
  return start;
}

TEST(GravityAlignment, UnderWay) {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 0.05;
  for (std::uint64_t n = 0; n < 10; ++n) {
    const Start start = drawn_start(n, {}, noise);
    const auto found = align_gravity(start.odometry, start.samples, noise, {});
    ASSERT_TRUE(found);
    EXPECT_LT(tilt_error(*found, start.T_odometry_world), 4 * found->sigma_tilt_rad);
    EXPECT_LT(found->sigma_tilt_rad, 0.01);
    EXPECT_NEAR(found->measured_gravity_mps2, 9.81, 0.3);
    ASSERT_EQ(found->states.size(), 31U);
    const InertialState& middle = found->states[15];
    EXPECT_LT((middle.bias.gyroscope_radps - start.bias.gyroscope_radps).norm(), 4e-3);
    const Eigen::Vector3d velocity =
        found->R_world_odometry * start.T_odometry_world.rotate(start.motion.velocity(1.5));
    EXPECT_LT((middle.velocity_mps - velocity).norm(), 0.1);
  }
}

/// At rest the accelerometer bias cannot be distinguished from tilt; the stated sigma must reflect that.
TEST(GravityAlignment, AtRest) {
  ImuNoiseParams noise;
  noise.sigma_accelerometer_bias_mps2 = 0.05;
  test::Liveliness none;
  none.way_m = none.turn_rad = none.speed_mps = none.turning_radps = 0;
  double squared = 0;
  constexpr int kStarts = 40;
  for (std::uint64_t n = 0; n < kStarts; ++n) {
    const Start start = drawn_start(n, none, noise);
    std::vector<StampedPose<SE3>> rows;
    for (const auto& row : start.odometry) rows.push_back({row.stamp, start.odometry.front().pose});
    const auto found = align_gravity(Trajectory<SE3>(std::move(rows)), start.samples, noise, {});
    ASSERT_TRUE(found);
    const SE3 T_odometry_world = start.odometry.front().pose * start.motion.pose(0).inverse();
    squared += std::pow(tilt_error(*found, T_odometry_world) / found->sigma_tilt_rad, 2) / kStarts;
    EXPECT_LT((found->states[0].bias.gyroscope_radps - start.bias.gyroscope_radps).norm(), 2e-3);
    for (const auto& state : found->states) EXPECT_LT(state.velocity_mps.norm(), 0.05);
  }
  EXPECT_NEAR(squared, 2, 1);  // two directions
}

TEST(GravityAlignment, RefusesWhatDoesNotBelongTogether) {
  const ImuNoiseParams noise;
  const Start start = drawn_start(1, {}, noise);
  std::vector<StampedPose<SE3>> few(start.odometry.begin(), start.odometry.begin() + 3);
  EXPECT_FALSE(align_gravity(Trajectory<SE3>(few), start.samples, noise, {}));
  auto missing = start.samples;
  missing.erase(missing.begin() + 200, missing.begin() + 300);
  EXPECT_FALSE(align_gravity(start.odometry, missing, noise, {}));
  auto in_g = start.samples;
  for (auto& sample : in_g) sample.specific_force_mps2 /= 9.81;
  EXPECT_FALSE(align_gravity(start.odometry, in_g, noise, {}));
  EXPECT_TRUE(align_gravity(start.odometry, start.samples, noise, {}));
  EXPECT_FALSE(align_gravity({}, start.samples, noise, {}));
}

}  // namespace
}  // namespace radioslam

#include "radioslam/inertial/imu_path.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kEnd_s = 20, kReadings_hz = 100, kScan_s = 0.25;
const ImuNoiseParams kNoise;

struct Walk {
  SmoothMotion motion;
  Trajectory<SE3> scans;
  std::vector<ImuSample> samples;
};

/// A turning robot whose IMU has constant biases.
Walk walk(std::uint64_t seed) {
  Rng rng(seed);
  Walk walk{SmoothMotion(rng, {}), {}, {}};
  std::vector<StampedPose<SE3>> scans;
  for (double t = 0; t <= kEnd_s; t += kScan_s)
    scans.push_back({Stamp::from_seconds(t), walk.motion.pose(t)});
  walk.scans = Trajectory<SE3>(std::move(scans));
  walk.samples = perfect_readings(walk.motion, kEnd_s, kReadings_hz, kNoise);
  for (ImuSample& sample : walk.samples) {
    sample.angular_rate_radps += Eigen::Vector3d(0.01, -0.02, 0.015);
    sample.specific_force_mps2 += Eigen::Vector3d(0.1, -0.2, 0.15);
  }
  return walk;
}

struct Errors {
  double worst_m = 0, worst_rad = 0;
};

/// At the samples.
Errors errors_of(const Trajectory<SE3>& path, const Walk& walk) {
  Errors errors;
  for (const ImuSample& sample : walk.samples) {
    const SE3 off = walk.motion.pose(sample.stamp.seconds()).inverse() * *path.at(sample.stamp);
    errors.worst_m = std::max(errors.worst_m, off.translation().norm());
    errors.worst_rad = std::max(errors.worst_rad, off.log().tail<3>().norm());
  }
  return errors;
}

TEST(ImuPath, FollowsTurnsAndAccelerationsBetweenScans) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Walk of = walk(seed);
    const auto path =
        with_imu_path(of.scans, of.scans.front().stamp, of.scans.back().stamp, of.samples, kNoise);
    EXPECT_EQ(path.size(), of.samples.size());
    const Errors straight = errors_of(of.scans, of), followed = errors_of(path, of);
    EXPECT_LT(followed.worst_rad, 0.02 * straight.worst_rad) << "seed " << seed;
    EXPECT_LT(followed.worst_m, 0.1 * straight.worst_m) << "seed " << seed;
    for (const auto& scan : of.scans)
      EXPECT_LT((path.at(scan.stamp)->inverse() * scan.pose).log().norm(), 1e-12);
  }
}

TEST(ImuPath, HasNoRowsWithoutSamplesOrOutsideTheScans) {
  Walk of = walk(6);
  const Stamp first = Stamp::from_seconds(1), last = Stamp::from_seconds(10);
  std::erase_if(of.samples, [](const ImuSample& sample) {
    return 5 < sample.stamp.seconds() && sample.stamp.seconds() < 5.2;
  });
  const auto path = with_imu_path(of.scans, first, last, of.samples, kNoise);
  const auto per_scan = static_cast<std::size_t>(kScan_s * kReadings_hz) - 1;
  EXPECT_EQ(path.size(), of.scans.size() + per_scan * 35) << "9 s without the interval that has a gap";
  const auto without = with_imu_path(of.scans, first, last, {}, kNoise);
  ASSERT_EQ(without.size(), of.scans.size());
  for (std::size_t k = 0; k < without.size(); ++k)
    EXPECT_EQ(without[k].pose.translation(), of.scans[k].pose.translation());
}

}  // namespace
}  // namespace radioslam

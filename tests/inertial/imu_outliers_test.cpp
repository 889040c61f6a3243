#include "radioslam/inertial/imu_outliers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "inertial/smooth_motion.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kReadings = 200;

/// An IMU at rest.
std::vector<ImuSample> still_readings() {
  std::vector<ImuSample> samples;
  for (std::size_t k = 0; k < kReadings; ++k)
    samples.push_back({{static_cast<std::int64_t>(k) * 10'000'000}, {0, 0, 9.81}, {0, 0, 0}});
  return samples;
}

std::vector<Stamp> stamps_of(const std::vector<ImuSample>& samples) {
  std::vector<Stamp> stamps;
  for (const auto& sample : samples) stamps.push_back(sample.stamp);
  return stamps;
}

/// Expects exactly these samples to be removed.
void expect_left_out(const std::vector<ImuSample>& samples, const std::vector<std::size_t>& outliers) {
  const FilteredImu filtered = remove_imu_outliers(samples, {});
  std::vector<Stamp> expected = stamps_of(samples);
  for (auto k = outliers.rbegin(); k != outliers.rend(); ++k)
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(*k));
  EXPECT_EQ(filtered.removed, outliers.size());
  EXPECT_EQ(stamps_of(filtered.samples), expected);
}

TEST(ImuOutliers, OfALivelyMotionThereAreNone) {
  const ImuNoiseParams noise;
  for (std::uint64_t n = 0; n < 5; ++n) {
    Rng rng = Rng(51).split(n);
    const test::SmoothMotion motion(rng.split("motion"), {2, 1, 6, 1, 0.5});
    auto samples = test::perfect_readings(motion, 5, 100, noise);
    test::add_errors(samples, {}, 100, noise, rng);
    expect_left_out(samples, {});
  }
}

TEST(ImuOutliers, ThatNoUnitMeasuresAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  auto samples = still_readings();
  samples[0].specific_force_mps2.x() = nan;
  samples[20].angular_rate_radps.y() = nan;
  samples[21].specific_force_mps2.z() = -inf;
  samples[100].angular_rate_radps.z() = 1e4;
  samples[kReadings - 1].specific_force_mps2.y() = 1e9;
  expect_left_out(samples, {0, 20, 21, 100, kReadings - 1});
}

/// A single outlier, at any position and in any component.
TEST(ImuOutliers, ThatAreSingleAreRemoved) {
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, std::size_t{77}, kReadings - 1})
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      for (const double side : {1.0, -1.0}) {
        auto samples = still_readings();
        samples[at].specific_force_mps2[axis] += side * 31;
        expect_left_out(samples, {at});
        samples = still_readings();
        samples[at].angular_rate_radps[axis] += side * 5.1;
        expect_left_out(samples, {at});
        samples = still_readings();
        samples[at].specific_force_mps2[axis] += side * 29;
        samples[at].angular_rate_radps[axis] += side * 4.9;
        expect_left_out(samples, {});
      }
}

/// Neighbours at 1, 1, 1, -1, -1, -1: their median with the reading is 1, the median distance to it 2.
TEST(ImuOutliers, AmongRestlessOnesMayJumpFurther) {
  for (const double force : {50.9, 51.1}) {
    auto samples = still_readings();
    for (std::size_t k = 0; k < kReadings; ++k) samples[k].specific_force_mps2.x() = k % 2 == 0 ? 1 : -1;
    samples[99].specific_force_mps2.x() = 1;
    samples[101].specific_force_mps2.x() = -1;
    samples[100].specific_force_mps2.x() = force;
    if (force > 51)
      expect_left_out(samples, {100});
    else
      expect_left_out(samples, {});
  }
}

TEST(ImuOutliers, OfABlowAreKept) {
  auto samples = still_readings();
  for (std::size_t k = 50; k < 55; ++k) samples[k].specific_force_mps2 += Eigen::Vector3d(-300, 200, 150);
  expect_left_out(samples, {});
}

TEST(ImuOutliers, AreNotFoundTwice) {
  auto samples = still_readings();
  for (const std::size_t k : {10U, 60U, 61U, 130U}) samples[k].angular_rate_radps.x() = 20;
  const FilteredImu once = remove_imu_outliers(samples, {});
  EXPECT_EQ(once.removed, 4U);
  const FilteredImu twice = remove_imu_outliers(once.samples, {});
  EXPECT_EQ(twice.removed, 0U);
  EXPECT_EQ(stamps_of(twice.samples), stamps_of(once.samples));
}

/// Up to one twentieth of the samples is removed.
TEST(ImuOutliers, AreAllKeptWhereTheyAreMany) {
  auto samples = still_readings();
  std::vector<std::size_t> outliers;
  for (std::size_t k = 5; outliers.size() < kReadings / 20; k += 17) {
    samples[k].specific_force_mps2.z() = 500;
    outliers.push_back(k);
  }
  expect_left_out(samples, outliers);
  samples[2].specific_force_mps2.z() = 500;
  expect_left_out(samples, {});
}

}  // namespace
}  // namespace radioslam

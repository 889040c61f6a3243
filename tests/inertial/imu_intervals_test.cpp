#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

constexpr double kMaxGap_s = 0.1;

/// Rate and force linear in time, so that means over intervals give their integrals exactly.
ImuSample reading_at(double t) { return {Stamp::from_seconds(t), {1 - 2 * t, t, 3}, {4 * t, -t, 0.5 + t}}; }

/// At irregular times.
std::vector<ImuSample> uneven_readings() {
  std::vector<ImuSample> samples;
  for (const double t : {0.0, 0.01, 0.025, 0.03, 0.08, 0.09, 0.17, 0.2}) samples.push_back(reading_at(t));
  return samples;
}

auto intervals_between(const std::vector<ImuSample>& samples, double from_s, double to_s) {
  return imu_intervals(samples, Stamp::from_seconds(from_s), Stamp::from_seconds(to_s), kMaxGap_s);
}

struct Sums {
  double duration_s = 0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), push = Eigen::Vector3d::Zero();
};

Sums summed(const std::vector<ImuInterval>& intervals) {
  Sums sums;
  for (const ImuInterval& interval : intervals) {
    sums.duration_s += interval.duration_s;
    sums.turn += interval.duration_s * interval.angular_rate_radps;
    sums.push += interval.duration_s * interval.specific_force_mps2;
  }
  return sums;
}

/// The ends may or may not be stamps of samples.
TEST(ReadingIntervals, SumUpToTheIntegralOfEvenlyGrowingReadings) {
  for (const auto& [from, to] :
       {std::pair(0.0, 0.2), {0.01, 0.09}, {0.012, 0.0245}, {0.028, 0.181}, {0.1, 0.11}}) {
    const auto intervals = intervals_between(uneven_readings(), from, to);
    ASSERT_TRUE(intervals) << from;
    const Sums sums = summed(*intervals);
    const double middle = (from + to) / 2, duration = to - from;
    EXPECT_NEAR(sums.duration_s, duration, 1e-9);
    EXPECT_LT((sums.turn - duration * reading_at(middle).angular_rate_radps).norm(), 1e-9) << from;
    EXPECT_LT((sums.push - duration * reading_at(middle).specific_force_mps2).norm(), 1e-9) << from;
  }
}

TEST(ReadingIntervals, ReachFromReadingToReading) {
  const auto intervals = intervals_between(uneven_readings(), 0.02, 0.08);
  ASSERT_TRUE(intervals);
  ASSERT_EQ(intervals->size(), 3U);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR((*intervals)[k].duration_s, (std::array{0.005, 0.005, 0.05})[k], 1e-9);
  EXPECT_LT(((*intervals)[2].angular_rate_radps - reading_at(0.055).angular_rate_radps).norm(), 1e-9);
}

TEST(ReadingIntervals, BeyondTheReadingsKeepTheLastValues) {
  const auto before = intervals_between(uneven_readings(), -0.05, 0),
             after = intervals_between(uneven_readings(), 0.2, 0.29);
  ASSERT_TRUE(before && after);
  EXPECT_LT((summed(*before).turn - 0.05 * reading_at(0).angular_rate_radps).norm(), 1e-9);
  EXPECT_LT((summed(*after).push - 0.09 * reading_at(0.2).specific_force_mps2).norm(), 1e-9);
}

TEST(ReadingIntervals, OfNoTimeThereAreNone) {
  for (const double t : {0.0, 0.03, 0.1, 0.2}) {
    const auto intervals = intervals_between(uneven_readings(), t, t);
    ASSERT_TRUE(intervals) << t;
    EXPECT_TRUE(intervals->empty()) << t;
  }
}

TEST(ReadingIntervals, RefuseGaps) {
  auto samples = uneven_readings();
  EXPECT_FALSE(intervals_between(samples, -0.11, 0.1));  // before the first
  EXPECT_FALSE(intervals_between(samples, 0.1, 0.31));   // after the last
  EXPECT_FALSE(intervals_between({}, 0, 0.1));
  EXPECT_TRUE(intervals_between(samples, 0, 0.2));
  samples.push_back(reading_at(0.31));
  EXPECT_FALSE(intervals_between(samples, 0, 0.31));     // in between
  EXPECT_FALSE(intervals_between(samples, 0.25, 0.31));  // starts inside the gap
  EXPECT_FALSE(intervals_between(samples, 0.1, 0.25));   // ends inside the gap
  EXPECT_TRUE(intervals_between(samples, 0, 0.2));
  EXPECT_TRUE(intervals_between(samples, 0.31, 0.32));
}

TEST(ReadingIntervalsDeathTest, RunForward) {
  EXPECT_DEATH(intervals_between(uneven_readings(), 0.1, 0.05), "forward in time");
}

}  // namespace
}  // namespace radioslam

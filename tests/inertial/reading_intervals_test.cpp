#include "radioslam/inertial/reading_intervals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace radioslam {
namespace {

constexpr double kLongestGap_s = 0.1;

/// Rate and force that grow evenly with time, so that means over pieces tell their integrals exactly.
InertialSample reading_at(double t) {
  return {Stamp::from_seconds(t), {1 - 2 * t, t, 3}, {4 * t, -t, 0.5 + t}};
}

/// At times as uneven as a unit's may be.
std::vector<InertialSample> uneven_readings() {
  std::vector<InertialSample> samples;
  for (const double t : {0.0, 0.01, 0.025, 0.03, 0.08, 0.09, 0.17, 0.2}) samples.push_back(reading_at(t));
  return samples;
}

auto pieces_between(const std::vector<InertialSample>& samples, double from_s, double to_s) {
  return reading_intervals(samples, Stamp::from_seconds(from_s), Stamp::from_seconds(to_s), kLongestGap_s);
}

struct Sums {
  double duration_s = 0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), push = Eigen::Vector3d::Zero();
};

Sums summed(const std::vector<ReadingInterval>& pieces) {
  Sums sums;
  for (const ReadingInterval& piece : pieces) {
    sums.duration_s += piece.duration_s;
    sums.turn += piece.duration_s * piece.angular_rate_radps;
    sums.push += piece.duration_s * piece.specific_force_mps2;
  }
  return sums;
}

/// Whether or not the ends are stamps of readings.
TEST(ReadingIntervals, SumUpToTheIntegralOfEvenlyGrowingReadings) {
  for (const auto& [from, to] :
       {std::pair(0.0, 0.2), {0.01, 0.09}, {0.012, 0.0245}, {0.028, 0.181}, {0.1, 0.11}}) {
    const auto pieces = pieces_between(uneven_readings(), from, to);
    ASSERT_TRUE(pieces) << from;
    const Sums sums = summed(*pieces);
    const double middle = (from + to) / 2, duration = to - from;
    EXPECT_NEAR(sums.duration_s, duration, 1e-9);
    EXPECT_LT((sums.turn - duration * reading_at(middle).angular_rate_radps).norm(), 1e-9) << from;
    EXPECT_LT((sums.push - duration * reading_at(middle).specific_force_mps2).norm(), 1e-9) << from;
  }
}

TEST(ReadingIntervals, ReachFromReadingToReading) {
  const auto pieces = pieces_between(uneven_readings(), 0.02, 0.08);
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->size(), 3U);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR((*pieces)[k].duration_s, (std::array{0.005, 0.005, 0.05})[k], 1e-9);
  EXPECT_LT(((*pieces)[2].angular_rate_radps - reading_at(0.055).angular_rate_radps).norm(), 1e-9);
}

TEST(ReadingIntervals, BeyondTheReadingsKeepTheLastValues) {
  const auto before = pieces_between(uneven_readings(), -0.05, 0),
             after = pieces_between(uneven_readings(), 0.2, 0.29);
  ASSERT_TRUE(before && after);
  EXPECT_LT((summed(*before).turn - 0.05 * reading_at(0).angular_rate_radps).norm(), 1e-9);
  EXPECT_LT((summed(*after).push - 0.09 * reading_at(0.2).specific_force_mps2).norm(), 1e-9);
}

TEST(ReadingIntervals, OfNoTimeThereAreNone) {
  for (const double t : {0.0, 0.03, 0.1, 0.2}) {
    const auto pieces = pieces_between(uneven_readings(), t, t);
    ASSERT_TRUE(pieces) << t;
    EXPECT_TRUE(pieces->empty()) << t;
  }
}

TEST(ReadingIntervals, RefuseGaps) {
  auto samples = uneven_readings();
  EXPECT_FALSE(pieces_between(samples, -0.11, 0.1));  // before the first
  EXPECT_FALSE(pieces_between(samples, 0.1, 0.31));   // after the last
  EXPECT_FALSE(pieces_between({}, 0, 0.1));
  EXPECT_TRUE(pieces_between(samples, 0, 0.2));
  samples.push_back(reading_at(0.31));
  EXPECT_FALSE(pieces_between(samples, 0, 0.31));     // in between
  EXPECT_FALSE(pieces_between(samples, 0.25, 0.31));  // the first end lies in it
  EXPECT_FALSE(pieces_between(samples, 0.1, 0.25));   // the last end does
  EXPECT_TRUE(pieces_between(samples, 0, 0.2));
  EXPECT_TRUE(pieces_between(samples, 0.31, 0.32));
}

TEST(ReadingIntervalsDeathTest, RunForward) {
  EXPECT_DEATH(pieces_between(uneven_readings(), 0.1, 0.05), "forward in time");
}

}  // namespace
}  // namespace radioslam

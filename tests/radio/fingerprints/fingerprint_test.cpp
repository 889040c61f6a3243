#include "radioslam/radio/fingerprints/fingerprint.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

WifiReading reading(std::size_t access_point, float rssi_dbm) {
  return {AccessPointIndex(access_point), 2437, rssi_dbm};
}

WifiScan scan(double seconds, std::vector<WifiReading> readings = {reading(0, -50)}) {
  return {Stamp::from_seconds(seconds), std::move(readings)};
}

/// One metre per second along x, from 0 s to 20 s.
Robot walker(std::vector<WifiScan> scans) {
  std::vector<StampedPose<SE3>> rows;
  for (int t = 0; t <= 20; ++t) rows.push_back({Stamp::from_seconds(t), lift(SE2({t, 0}, 0))});
  Robot robot;
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.wifi = std::move(scans);
  return robot;
}

std::vector<int> scans_per_window(const std::vector<Fingerprint>& fingerprints) {
  std::vector<int> counts;
  for (const auto& fingerprint : fingerprints) counts.push_back(fingerprint.scans);
  return counts;
}

TEST(MakeFingerprints, AWindowStartsWithAScanAndLastsFiveSeconds) {
  const auto fingerprints = make_fingerprints({scan(1), scan(3), scan(5.999), scan(6), scan(20)}, {});
  EXPECT_EQ(scans_per_window(fingerprints), std::vector<int>({3, 1, 1}));
}

TEST(MakeFingerprints, AWindowEndsAfterItsPathLength) {
  const auto scans = {scan(0), scan(1), scan(1.9), scan(2), scan(3), scan(5)};
  EXPECT_EQ(scans_per_window(make_fingerprints(walker(scans), {5, 2})), std::vector<int>({3, 2, 1}));
  EXPECT_EQ(scans_per_window(make_fingerprints(walker(scans), {5, 100})), std::vector<int>({5, 1}));
}

TEST(MakeFingerprints, LeavesOutScansOutsideTheOdometry) {
  const auto fingerprints = make_fingerprints(walker({scan(-0.1), scan(0), scan(20), scan(20.1)}), {});
  ASSERT_EQ(fingerprints.size(), 2U);
  EXPECT_EQ(fingerprints[0].stamp, Stamp::from_seconds(0));
  EXPECT_EQ(fingerprints[1].stamp, Stamp::from_seconds(20));
}

TEST(MakeFingerprints, AveragesOverTheScansThatHeardAnAccessPoint) {
  const auto fingerprints =
      make_fingerprints({scan(1, {reading(3, -50), reading(7, -80)}), scan(2, {reading(7, -70)}),
                         scan(3, {reading(2, -90), reading(3, -60)}), scan(4, {})},
                        {});
  ASSERT_EQ(fingerprints.size(), 1U);
  const auto& entries = fingerprints[0].entries;
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].access_point, AccessPointIndex(2));
  EXPECT_EQ(entries[1].access_point, AccessPointIndex(3));
  EXPECT_EQ(entries[2].access_point, AccessPointIndex(7));
  EXPECT_FLOAT_EQ(entries[0].rss_dbm, -90);
  EXPECT_FLOAT_EQ(entries[1].rss_dbm, -55);
  EXPECT_FLOAT_EQ(entries[2].rss_dbm, -75);
  EXPECT_FLOAT_EQ(entries[0].detection_rate, 0.25F);
  EXPECT_FLOAT_EQ(entries[1].detection_rate, 0.5F);
}

TEST(MakeFingerprints, IsStampedAtTheMeanOfItsScans) {
  EXPECT_EQ(make_fingerprints({scan(1), scan(2), scan(4.5)}, {})[0].stamp, Stamp::from_seconds(2.5));
  // Sums of stamps since 1970 would overflow 64 bits.
  constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'001, kQuarter_ns = 250'000'000;
  std::vector<WifiScan> many;
  for (int i = 0; i < 13; ++i) many.push_back({Stamp{kNow_ns + i * kQuarter_ns}, {reading(0, -50)}});
  EXPECT_EQ(make_fingerprints(many, {})[0].stamp, Stamp{kNow_ns + 6 * kQuarter_ns});
}

TEST(MakeFingerprints, NothingComesOfNoScans) { EXPECT_TRUE(make_fingerprints(walker({}), {}).empty()); }

}  // namespace
}  // namespace radioslam

#include "radioslam/lidar/scan_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

SE3::Tangent turning_twist() {
  SE3::Tangent twist;
  twist << 4, -1, 0.3, 0.2, -0.1, 1.5;
  return twist;
}

/// Static points around a body that moves with the twist, each as seen at its own time.
struct DeskewedPoints {
  LidarScan scan;
  std::vector<Eigen::Vector3d> at_stamp;
};

DeskewedPoints swept_points(int count, double begin_s, double end_s, Rng& rng) {
  DeskewedPoints swept;
  for (int k = 0; k < count; ++k) {
    const double time_s = begin_s + (end_s - begin_s) * k / (count - 1);
    const double x = rng.uniform(-20, 20), y = rng.uniform(1, 20), z = rng.uniform(-2, 5);
    swept.at_stamp.emplace_back(x, y, z);
    const SE3 T = SE3::exp(time_s * turning_twist());
    swept.scan.points.emplace_back((T.inverse() * swept.at_stamp.back()).cast<float>());
    swept.scan.times_s.push_back(static_cast<float>(time_s));
  }
  return swept;
}

double worst_error_m(const ScanPoints& usable, const std::vector<Eigen::Vector3d>& expected) {
  EXPECT_EQ(usable.points.size(), expected.size());
  double worst = 0;
  for (std::size_t k = 0; k < usable.points.size(); ++k)
    worst = std::max(worst, (usable.points[k].cast<double>() - expected[k]).norm());
  return worst;
}

TEST(UsablePoints, CountsWhatItLeavesOut) {
  LidarScan scan;
  scan.points = {{1, 2, 3},    {kNaN, 0, 0}, {0, kNaN, 1},   {0, 0, kInfinite}, {-kInfinite, 1, 1}, {0, 0, 0},
                 {0.1F, 0, 0}, {481, 0, 0},  {0, -300, 300}, {1e30F, 0, 0},     {-5, -6, 0.5F}};
  const ScanPoints usable = filter_and_deskew(scan, SE3::Tangent::Zero(), {0.5, 100});
  ASSERT_EQ(usable.points.size(), 2U);
  EXPECT_EQ(usable.points[0], scan.points.front());
  EXPECT_EQ(usable.points[1], scan.points.back());
  EXPECT_EQ(usable.counts.used, 2U);
  EXPECT_EQ(usable.counts.not_finite, 4U);
  EXPECT_EQ(usable.counts.near, 2U);
  EXPECT_EQ(usable.counts.far, 3U);
}

TEST(UsablePoints, CountsAddUp) {
  PointCounts sum{1, 2, 3, 4};
  sum += {10, 20, 30, 40};
  EXPECT_EQ(sum.used, 11U);
  EXPECT_EQ(sum.not_finite, 22U);
  EXPECT_EQ(sum.near, 33U);
  EXPECT_EQ(sum.far, 44U);
}

TEST(UsablePoints, PutsSweptPointsBackWhereTheStampSawThem) {
  Rng rng(1);
  for (const double begin_s : {0.0, -0.05, -0.1}) {
    const auto [scan, expected] = swept_points(257, begin_s, begin_s + 0.1, rng);
    EXPECT_LT(worst_error_m(filter_and_deskew(scan, turning_twist(), {}), expected), 1e-4) << begin_s;
  }
}

/// Points between the tabulated times of the motion are accurate to a millimetre per m/s.
TEST(UsablePoints, PutsEveryPointBackHoweverManyThereAre) {
  Rng rng(2);
  const auto [scan, expected] = swept_points(6000, 0, 0.1, rng);
  const double fastest = turning_twist().head<3>().norm() + 29 * turning_twist().tail<3>().norm();
  EXPECT_LT(worst_error_m(filter_and_deskew(scan, turning_twist(), {}), expected), 0.0005 * fastest);
  EXPECT_GT(worst_error_m(filter_and_deskew(scan, SE3::Tangent::Zero(), {}), expected), 1);
}

TEST(UsablePoints, WithoutTimesLeavesPointsWhereTheyAre) {
  Rng rng(3);
  auto scan = swept_points(50, 0, 0.1, rng).scan;
  scan.times_s.clear();
  EXPECT_EQ(filter_and_deskew(scan, turning_twist(), {}).points, scan.points);
}

TEST(UsablePoints, TakesTimesThatAreAllTheSame) {
  LidarScan scan;
  scan.points = {{3, 0, 0}, {0, 4, 0}};
  for (const float time_s : {0.0F, 0.05F, -20.0F}) {
    scan.times_s = {time_s, time_s};
    const ScanPoints usable = filter_and_deskew(scan, turning_twist(), {});
    const SE3 T = SE3::exp(static_cast<double>(time_s) * turning_twist());
    EXPECT_LT(worst_error_m(usable, {T * Eigen::Vector3d(3, 0, 0), T * Eigen::Vector3d(0, 4, 0)}), 1e-4);
  }
}

TEST(UsablePoints, LeavesOutPointsWhoseTimeIsNoNumber) {
  Rng rng(4);
  auto [scan, expected] = swept_points(257, 0, 0.1, rng);
  const float broken[] = {kNaN, kInfinite, -kInfinite};
  for (std::size_t k = 0; k < 3; ++k) {
    scan.points.insert(scan.points.begin(), Eigen::Vector3f(1, 2, 3));
    scan.times_s.insert(scan.times_s.begin(), broken[k]);
  }
  const ScanPoints usable = filter_and_deskew(scan, turning_twist(), {});
  EXPECT_EQ(usable.counts.not_finite, 3U);
  EXPECT_LT(worst_error_m(usable, expected), 1e-4);
  scan.points.resize(3);
  scan.times_s.resize(3);
  EXPECT_EQ(filter_and_deskew(scan, turning_twist(), {}).counts.not_finite, 3U);
}

/// A time of a thousand years would move its point beyond any map.
TEST(UsablePoints, LeavesOutPointsWithImpossibleTimes) {
  for (const float impossible_s : {-3e10F, 3e10F, -3e38F, 3e38F}) {
    LidarScan scan;
    scan.points = {{3, 0, 0}, {0, 4, 0}, {0, 5, 0}};
    scan.times_s = {0, impossible_s, 0.1F};
    const ScanPoints usable = filter_and_deskew(scan, turning_twist(), {});
    const SE3 T = SE3::exp(0.1 * turning_twist());
    EXPECT_LT(worst_error_m(usable, {{3, 0, 0}, T * Eigen::Vector3d(0, 5, 0)}), 1e-4);
    EXPECT_EQ(usable.counts.off_time, 1U) << impossible_s;
    EXPECT_EQ(usable.counts.not_finite, 0U);
    EXPECT_GE(usable.middle_s, 0);
    EXPECT_LE(usable.middle_s, 0.11);
  }
}

TEST(UsablePoints, KnowTheMiddleOfTheirTimes) {
  Rng rng(5);
  EXPECT_NEAR(filter_and_deskew(swept_points(257, 0, 0.1, rng).scan, turning_twist(), {}).middle_s, 0.05,
              1e-3);
  EXPECT_NEAR(filter_and_deskew(swept_points(257, -0.1, 0, rng).scan, turning_twist(), {}).middle_s, -0.05,
              1e-3);
  LidarScan untimed;
  untimed.points = {{3, 0, 0}};
  EXPECT_EQ(filter_and_deskew(untimed, turning_twist(), {}).middle_s, 0);
}

TEST(UsablePoints, OfAnEmptyScanThereAreNone) {
  const ScanPoints usable = filter_and_deskew({}, turning_twist(), {});
  EXPECT_TRUE(usable.points.empty());
  EXPECT_EQ(usable.counts.used + usable.counts.not_finite + usable.counts.near + usable.counts.far, 0U);
}

TEST(UsablePointsDeathTest, WantsATimePerPointOrNone) {
  LidarScan scan;
  scan.points = {{3, 0, 0}, {0, 4, 0}};
  scan.times_s = {0};
  EXPECT_DEATH(filter_and_deskew(scan, turning_twist(), {}), "one time per point, or none");
}

}  // namespace
}  // namespace radioslam

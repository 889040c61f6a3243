#include "radioslam/lidar/deskew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "inertial/smooth_motion.hpp"
#include "radioslam/lidar/scan_points.hpp"

namespace radioslam {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Random points, one measured every millisecond from `first_s` on, seen from the moving `pose_at`.
struct SweptScan {
  LidarScan scan;
  std::vector<Eigen::Vector3d> at_stamp;  ///< in the body frame at the stamp
};

template <class PoseAt>
SweptScan swept_scan(double first_s, const PoseAt& pose_at) {
  Rng rng(81);
  SweptScan swept;
  for (int k = 0; k < 100; ++k) {
    const double time_s = first_s + 0.001 * k;
    Eigen::Vector3d point = test::normal_vector(rng, 8);
    if (point.norm() < 1) point.x() += 2;
    swept.at_stamp.push_back(point);
    swept.scan.points.push_back((pose_at(time_s).inverse() * point).template cast<float>());
    swept.scan.times_s.push_back(static_cast<float>(time_s));
  }
  return swept;
}

template <class PoseAt>
ScanMotion motion_along(const ScanTimeSpan& time, const PoseAt& pose_at, std::size_t poses = 257) {
  ScanMotion table{time, std::vector<SE3>(poses)};
  for (std::size_t k = 0; k < table.poses.size(); ++k) table.poses[k] = pose_at(table.time_of(k));
  return table;
}

TEST(ScanTimeSpan, IsOfThePossibleTimes) {
  LidarScan scan;
  scan.times_s = {
      0.04F, kNan, -0.01F, 1e9F, 0.02F, -61, 0.03F, -0.02F, std::numeric_limits<float>::infinity()};
  const ScanTimeSpan time = time_span(scan, {});
  EXPECT_EQ(time.first_s, static_cast<double>(-0.02F));
  EXPECT_EQ(time.middle_s, static_cast<double>(0.02F));
  EXPECT_EQ(time.last_s, static_cast<double>(0.04F));
  for (const std::vector<float>& none : {std::vector<float>{}, {kNan, 100}}) {
    scan.times_s = none;
    const ScanTimeSpan zero = time_span(scan, {});
    EXPECT_EQ(zero.first_s, 0);
    EXPECT_EQ(zero.middle_s, 0);
    EXPECT_EQ(zero.last_s, 0);
  }
}

TEST(ScanMotion, HasAPoseNearestToEveryTime) {
  ScanMotion table{{-0.02, 0.03, 0.08}, std::vector<SE3>(11)};
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    table.poses[k] = SE3({static_cast<double>(k), 0, 0}, Eigen::Quaterniond::Identity());
    EXPECT_NEAR(table.time_of(k), -0.02 + 0.01 * static_cast<double>(k), 1e-12);
    for (const double off_s : {-0.004, 0.0, 0.004}) EXPECT_EQ(table.nearest(table.time_of(k) + off_s), k);
  }
  EXPECT_EQ(table.nearest(-5), 0U);
  EXPECT_EQ(table.nearest(5), 10U);
  EXPECT_EQ(table.middle().translation().x(), 5);
  const ScanMotion still{{}, {SE3()}};
  EXPECT_EQ(still.nearest(0.1), 0U);
}

/// Arbitrary smooth motion, with the stamp before, in and after the sweep.
TEST(Deskew, PutsPointsWhereTheStampSawThem) {
  const test::SmoothMotion motion(Rng(82), {0.5, 0.5, 8, 1, 1});
  for (const double first_s : {0.02, -0.05, -0.12}) {
    const auto pose_at = [&](double time_s) { return motion.pose(2).inverse() * motion.pose(2 + time_s); };
    const SweptScan swept = swept_scan(first_s, pose_at);
    const ScanMotion table = motion_along(time_span(swept.scan, {}), pose_at, 2001);
    const LidarScan deskewed_scan = deskew(swept.scan, table, {});
    EXPECT_TRUE(deskewed_scan.times_s.empty());
    ASSERT_EQ(deskewed_scan.points.size(), swept.at_stamp.size());
    double distortion_m = 0;
    for (std::size_t k = 0; k < swept.at_stamp.size(); ++k) {
      EXPECT_LT((deskewed_scan.points[k].cast<double>() - swept.at_stamp[k]).norm(), 2e-3) << k;
      distortion_m = std::max(distortion_m, (swept.scan.points[k].cast<double>() - swept.at_stamp[k]).norm());
    }
    EXPECT_GT(distortion_m, 0.1);
  }
}

/// Equals deskewing by a constant twist with the same number of steps.
TEST(Deskew, AgreesWithAConstantTwist) {
  SE3::Tangent twist_per_s;
  twist_per_s << 3, 0.5, -0.2, 0.1, -0.3, 1.5;
  const auto pose_at = [&](double time_s) { return SE3::exp(time_s * twist_per_s); };
  const SweptScan swept = swept_scan(-0.03, pose_at);
  const auto by_motion = deskew(swept.scan, motion_along(time_span(swept.scan, {}), pose_at), {}).points;
  const auto by_twist = filter_and_deskew(swept.scan, twist_per_s, {}).points;
  ASSERT_EQ(by_motion.size(), by_twist.size());
  for (std::size_t k = 0; k < by_motion.size(); ++k)
    EXPECT_LT((by_motion[k] - by_twist[k]).norm(), 1e-4F) << k;
}

TEST(Deskew, LeavesPointsThatCannotBeUsed) {
  const auto pose_at = [](double time_s) { return SE3({10 * time_s, 0, 0}, Eigen::Quaterniond::Identity()); };
  LidarScan scan;
  scan.points = {{5, 0, 0}, {0, 0, 0}, {0.1F, 0.1F, 0}, {5, 0, 0}, {5, 0, 0}, {kNan, 1, 2}};
  scan.times_s = {0.1F, 0.1F, 0.1F, kNan, 1000, 0.05F};
  const LidarScan result = deskew(scan, motion_along({0.05, 0.1, 0.1}, pose_at), {});
  EXPECT_NEAR(result.points[0].x(), 6, 1e-5);
  EXPECT_EQ(result.points[1], scan.points[1]);  // no return
  EXPECT_EQ(result.points[2], scan.points[2]);  // the robot itself
  EXPECT_FALSE(result.points[3].allFinite());
  EXPECT_FALSE(result.points[4].allFinite());
  EXPECT_FALSE(result.points[5].allFinite());
  const PointCounts counts = filter_and_deskew(result, SE3::Tangent::Zero(), {}).counts;
  EXPECT_EQ(counts.used, 1U);
  EXPECT_EQ(counts.near, 2U);
  EXPECT_EQ(counts.not_finite, 3U);
}

TEST(Deskew, WithoutTimesStaysAsItIs) {
  LidarScan scan;
  scan.points = {{5, 1, 2}};
  const ScanMotion table{{0, 0, 0}, {SE3({1, 2, 3}, Eigen::Quaterniond::Identity())}};
  EXPECT_EQ(deskew(scan, table, {}).points[0], scan.points[0]);
}

}  // namespace
}  // namespace radioslam

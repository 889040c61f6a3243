#include "radioslam/pipeline/sweep_bend.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/pipeline/scan_guess.hpp"

namespace radioslam {
namespace {

constexpr double kInterval_s = 0.1, kSwept_s = 0.08;

/// A body that speeds up by `change_mps2` along x and turns ever faster about z.
double way_m(double t, double change_mps2) { return 0.5 * change_mps2 * t * t; }

/// Of a line of time from -length/2 on.
template <class Off>
double rms_over(double length_s, const Off& off) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += std::pow(off(length_s * ((k + 0.5) / kSteps - 0.5)), 2);
  return std::sqrt(sum / kSteps);
}

SweepBend bend_of(double change_mps2) {
  SweepBend bend(0.5);
  for (int k = 0; k < 60; ++k)
    bend.add(Stamp::from_seconds(kInterval_s * k),
             SE3({way_m(kInterval_s * k, change_mps2), 0, 0}, Eigen::Quaterniond::Identity()));
  return bend;
}

/// Unbent by the speed from the middle of the last sweep to that of this one.
TEST(SweepBend, IsWhatAMotionHalfAnIntervalOldLeaves) {
  const double change_mps2 = 4;
  const double speed_mps = 7, old_mps = speed_mps - 0.5 * kInterval_s * change_mps2;
  const double off_m = rms_over(kSwept_s, [&](double t) { return (speed_mps - old_mps) * t; });
  const SE3::Tangent variances = bend_of(change_mps2).variances(SweptBy::kScans, kSwept_s, 10);
  EXPECT_NEAR(std::sqrt(variances[0]), off_m, 1e-3 * off_m);
  EXPECT_LT(variances.tail<5>().norm(), 1e-20);
}

/// Straight from row to row, which lie apart as scans do or farther.
TEST(SweepBend, IsWhatRowsLeaveBetweenThem) {
  const double change_mps2 = 4;
  for (const double rows_s : {0.05, 0.1, 0.4}) {
    const double half_s = rows_s / 2;
    const double off_m = rms_over(rows_s, [&](double t) {
      return way_m(t, change_mps2) - way_m(half_s, change_mps2);  // the chord between -half and half
    });
    const SE3::Tangent variances = bend_of(change_mps2).variances(SweptBy::kRecordedRows, rows_s, 10);
    EXPECT_NEAR(std::sqrt(variances[0]), off_m, 1e-3 * off_m);
  }
}

TEST(SweepBend, OfReadingsOrOfAnEvenMotionIsNone) {
  EXPECT_TRUE(bend_of(4).variances(SweptBy::kReadings, kSwept_s, 10).isZero(0));
  EXPECT_LT(bend_of(0).variances(SweptBy::kScans, kSwept_s, 10).norm(), 1e-20);
}

/// A bent turn moves the pose, across the axis of the turn.
TEST(SweepBend, OfTurnsIsOfThePositionToo) {
  SweepBend bend(0.5);
  for (int k = 0; k < 60; ++k)
    bend.add(Stamp::from_seconds(kInterval_s * k),
             SE3::exp((SE3::Tangent() << 0, 0, 0, 0, 0, way_m(kInterval_s * k, 4)).finished()));
  const SE3::Tangent variances = bend.variances(SweptBy::kScans, kSwept_s, 10);
  EXPECT_NEAR(variances[0], 100 * variances[5], 1e-9);
  EXPECT_NEAR(variances[1], 100 * variances[5], 1e-9);
  EXPECT_LT(variances.segment<3>(2).norm(), 1e-20);
  EXPECT_GT(variances[5], 1e-6);
}

TEST(SweepBend, IsNotKnownBeforeTheThirdScan) {
  SweepBend bend(1);
  for (const double x : {0.0, 1.0, 5.0}) {
    EXPECT_TRUE(bend.variances(SweptBy::kScans, kSwept_s, 10).isZero(0));
    bend.add(Stamp::from_seconds(x), SE3({x * x, 0, 0}, Eigen::Quaterniond::Identity()));
  }
  EXPECT_GT(bend.variances(SweptBy::kScans, kSwept_s, 10)[0], 0);
}

Trajectory<SE3> rows_of(double from_s, double to_s) {
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; from_s + 0.01 * k <= to_s + 1e-9; ++k) {
    const double t = from_s + 0.01 * k;
    rows.push_back({Stamp::from_seconds(t), SE3::exp((SE3::Tangent() << t, 0, 0, 0, 0, 0.5 * t).finished())});
  }
  return Trajectory<SE3>(std::move(rows));
}

TEST(GuessByOdometry, IsTheWayOfItsRows) {
  const auto rows = rows_of(0, 2);
  const SweptTime time{-0.02, 0.03, 0.08};
  const Stamp previous = Stamp::from_seconds(0.9), stamp = Stamp::from_seconds(1);
  const auto guess = guess_by_odometry(rows, previous, stamp, time);
  ASSERT_TRUE(guess);
  EXPECT_LT((guess->T_previous_body->inverse() * rows.at(previous)->inverse() * *rows.at(stamp)).log().norm(),
            1e-12);
  for (std::size_t k = 0; k < guess->way.poses.size(); ++k) {
    const SE3 way = SE3::exp(guess->way.time_of(k) * (SE3::Tangent() << 1, 0, 0, 0, 0, 0.5).finished());
    EXPECT_LT((guess->way.poses[k].inverse() * way).log().norm(), 1e-8);
  }
  EXPECT_FALSE(guess_by_odometry(rows, std::nullopt, stamp, time)->T_previous_body);
}

/// Of a sweep that odometry covers in part nothing is told.
TEST(GuessByOdometry, IsOfWholeSweepsOnly) {
  const SweptTime time{-0.02, 0.03, 0.08};
  const Stamp stamp = Stamp::from_seconds(1);
  EXPECT_FALSE(guess_by_odometry({}, std::nullopt, stamp, time));
  EXPECT_FALSE(guess_by_odometry(rows_of(0, 1.05), std::nullopt, stamp, time));
  EXPECT_FALSE(guess_by_odometry(rows_of(0.99, 2), std::nullopt, stamp, time));
  EXPECT_TRUE(guess_by_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.9), stamp, time));
  EXPECT_FALSE(
      guess_by_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.9), stamp, time)->T_previous_body);
}

}  // namespace
}  // namespace radioslam

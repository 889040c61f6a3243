#include "radioslam/pipeline/sweep_bend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/pipeline/scan_guess.hpp"

namespace radioslam {
namespace {

constexpr double kInterval_s = 0.1, kSwept_s = 0.08;

constexpr double kChange_mps2 = 4;

double way_m(double t) { return 0.5 * kChange_mps2 * t * t; }

/// A body that speeds up along x, or turns ever faster about z.
SE3 speeding_up(double t) { return {{way_m(t), 0, 0}, Eigen::Quaterniond::Identity()}; }
SE3 turning_up(double t) { return SE3::exp((SE3::Tangent() << 0, 0, 0, 0, 0, way_m(t)).finished()); }

/// Of a sweep with its stamp at a share of it.
SweptTime swept(double stamp_at) {
  return {-stamp_at * kSwept_s, (0.5 - stamp_at) * kSwept_s, (1 - stamp_at) * kSwept_s};
}

SweepBend bend_of(SE3 (*pose_at)(double), const std::vector<double>& times_s) {
  SweepBend bend(0.2, kInterval_s);
  for (const double t : times_s) bend.add(Stamp::from_seconds(t), pose_at(t));
  return bend;
}

std::vector<double> even_times(int count) {
  std::vector<double> times_s;
  for (int k = 0; k < count; ++k) times_s.push_back(kInterval_s * k);
  return times_s;
}

/// The pose at the stamp, from the middle by the motion since the last middle; the middle's own error apart.
TEST(SweepBend, IsWhatAMotionHalfAnIntervalOldLeaves) {
  const SweepBend bend = bend_of(speeding_up, even_times(60));
  const double at_middle = bend.variances(SweptBy::kScans, swept(0.5), 0, 10)[0];
  EXPECT_GT(at_middle, 0);
  for (const double stamp_at : {0.0, 0.2, 0.7, 1.0}) {
    const double m = swept(stamp_at).middle_s;
    const double twist_mps = (way_m(0) - way_m(-kInterval_s)) / kInterval_s;  // the middle is at 0
    const double off_m = -m * twist_mps - way_m(-m);
    const SE3::Tangent variances = bend.variances(SweptBy::kScans, swept(stamp_at), 0, 10);
    EXPECT_NEAR(variances[0] - at_middle, off_m * off_m, 1e-3 * off_m * off_m) << stamp_at;
    EXPECT_LT(variances.tail<5>().norm(), 1e-20);
  }
}

/// Straight from row to row.
TEST(SweepBend, IsWhatRowsLeaveBetweenThem) {
  const SweepBend bend = bend_of(speeding_up, even_times(60));
  for (const double rows_s : {0.02, 0.05, 0.1}) {
    constexpr int kSteps = 1000;
    double squares_m2 = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double t = rows_s * ((k + 0.5) / kSteps - 0.5);
      squares_m2 += std::pow(way_m(t) - way_m(rows_s / 2), 2) / kSteps;  // the chord between two rows
    }
    EXPECT_NEAR(bend.variances(SweptBy::kRecordedRows, swept(0), rows_s, 10)[0], squares_m2,
                2e-3 * squares_m2);
  }
}

TEST(SweepBend, OfReadingsOfAnEvenMotionOrOfScansWithoutTimesIsNone) {
  const SweepBend bend = bend_of(speeding_up, even_times(60));
  EXPECT_TRUE(bend.variances(SweptBy::kReadings, swept(0), 0.1, 10).isZero(0));
  EXPECT_TRUE(bend.variances(SweptBy::kScans, {}, 0.1, 10).isZero(0));
  const auto even = [](double t) { return SE3({7 * t, 0, 0}, Eigen::Quaterniond::Identity()); };
  EXPECT_LT(bend_of(even, even_times(60)).variances(SweptBy::kScans, swept(0), 0, 10).norm(), 1e-20);
}

/// Points all around that are bent by a turn have their mean elsewhere.
TEST(SweepBend, OfTurnsIsOfThePositionToo) {
  const SweepBend bend = bend_of(turning_up, even_times(60));
  const double range_m = 10, rows_s = 0.1;
  const SE3::Tangent variances = bend.variances(SweptBy::kRecordedRows, swept(0), rows_s, range_m);
  constexpr int kSteps = 1000;
  double shift_m = 0;
  for (int k = 0; k < kSteps; ++k) {  // bent by as much as in the model, rms, evenly along the azimuth
    const double azimuth = 2 * std::numbers::pi * ((k + 0.5) / kSteps - 0.5);
    const double off_rad = std::sqrt(3 * variances[5]) * azimuth / std::numbers::pi;
    shift_m += range_m * off_rad * std::sin(azimuth) / kSteps;
  }
  EXPECT_NEAR(variances[0], shift_m * shift_m, 1e-2 * shift_m * shift_m);
  EXPECT_NEAR(variances[1], variances[0], 1e-12);
  EXPECT_LT(variances.segment<3>(2).norm(), 1e-20);
  EXPECT_GT(variances[5], 1e-6);
}

/// From the third scan on in full, and a second start knows how lively the robot is.
TEST(SweepBend, IsKnownFromTheThirdScanOn) {
  const auto variance = [](const SweepBend& bend) {
    return bend.variances(SweptBy::kScans, swept(0), 0, 10)[0];
  };
  EXPECT_EQ(variance(bend_of(speeding_up, even_times(2))), 0);
  const double known = variance(bend_of(speeding_up, even_times(60)));
  EXPECT_NEAR(variance(bend_of(speeding_up, even_times(3))), known, 1e-9);
  SweepBend bend = bend_of(speeding_up, even_times(60));
  bend.begin_anew();
  bend.add(Stamp::from_seconds(100), SE3({-500, 0, 0}, Eigen::Quaterniond::Identity()));
  EXPECT_NEAR(variance(bend), known, 1e-9);
}

/// A scan that comes twice, or in a burst: what noise makes of so short a time is no motion.
TEST(SweepBend, OfABurstIsThatOfTheOthers) {
  std::vector<double> times_s = even_times(60);
  times_s.insert(times_s.begin() + 50, times_s[49] + 0.001);
  SweepBend bend(0.2, kInterval_s);
  for (const double t : times_s) {
    const double noise_m = std::remainder(1e4 * t, 3.0) / 150;
    bend.add(Stamp::from_seconds(t), SE3({way_m(t) + noise_m, 0, 0}, Eigen::Quaterniond::Identity()));
  }
  EXPECT_LT(bend.variances(SweptBy::kScans, swept(0), 0, 10)[0],
            20 * bend_of(speeding_up, even_times(60)).variances(SweptBy::kScans, swept(0), 0, 10)[0]);
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
  const auto guess = guess_by_odometry(rows, previous, stamp, time, 0.15);
  ASSERT_TRUE(guess);
  EXPECT_LT((guess->T_previous_body->inverse() * rows.at(previous)->inverse() * *rows.at(stamp)).log().norm(),
            1e-12);
  for (std::size_t k = 0; k < guess->way.poses.size(); ++k) {
    const SE3 way = SE3::exp(guess->way.time_of(k) * (SE3::Tangent() << 1, 0, 0, 0, 0, 0.5).finished());
    EXPECT_LT((guess->way.poses[k].inverse() * way).log().norm(), 1e-8);
  }
  EXPECT_FALSE(guess_by_odometry(rows, std::nullopt, stamp, time, 0.15)->T_previous_body);
}

/// Of a sweep that odometry covers in part nothing is told.
TEST(GuessByOdometry, IsOfWholeSweepsOnly) {
  const SweptTime time{-0.02, 0.03, 0.08};
  const Stamp stamp = Stamp::from_seconds(1);
  EXPECT_FALSE(guess_by_odometry({}, std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(guess_by_odometry(rows_of(0, 1.05), std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(guess_by_odometry(rows_of(0.99, 2), std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(guess_by_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.9), stamp, time, 0.15));
  EXPECT_TRUE(guess_by_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.97), stamp, time, 0.15));
}

/// Rows with a gap: what lies between is not known.
TEST(GuessByOdometry, IsOfNoGapBetweenRows) {
  std::vector<StampedPose<SE3>> rows;
  for (const auto& row : rows_of(0, 4))
    if (row.stamp <= Stamp::from_seconds(1) || row.stamp >= Stamp::from_seconds(3)) rows.push_back(row);
  const Trajectory<SE3> odometry(rows);
  const SweptTime time{0, 0.05, 0.1};
  for (const double t : {0.85, 3.15})
    EXPECT_TRUE(
        guess_by_odometry(odometry, Stamp::from_seconds(t - 0.1), Stamp::from_seconds(t), time, 0.15));
  for (const double t : {0.95, 1.5, 3.05})
    EXPECT_FALSE(
        guess_by_odometry(odometry, Stamp::from_seconds(t - 0.1), Stamp::from_seconds(t), time, 0.15));
}

}  // namespace
}  // namespace radioslam

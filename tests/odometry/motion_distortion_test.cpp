#include "radioslam/odometry/motion_distortion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/odometry/imu_motion_prior.hpp"

namespace radioslam {
namespace {

constexpr double kInterval_s = 0.1, kSwept_s = 0.08;

constexpr double kChange_mps2 = 4;

double path_m(double t) { return 0.5 * kChange_mps2 * t * t; }

/// A body that accelerates along x, or about z.
SE3 speeding_up(double t) { return {{path_m(t), 0, 0}, Eigen::Quaterniond::Identity()}; }
SE3 turning_up(double t) { return SE3::exp((SE3::Tangent() << 0, 0, 0, 0, 0, path_m(t)).finished()); }

/// Times of a sweep with its stamp at this fraction.
ScanTimeSpan swept(double stamp_at) {
  return {-stamp_at * kSwept_s, (0.5 - stamp_at) * kSwept_s, (1 - stamp_at) * kSwept_s};
}

DistortionCovariance distortion_of(SE3 (*pose_at)(double), const std::vector<double>& times_s) {
  DistortionCovariance distortion(0.2, kInterval_s);
  for (const double t : times_s) distortion.add(Stamp::from_seconds(t), pose_at(t));
  return distortion;
}

std::vector<double> even_times(int count) {
  std::vector<double> times_s;
  for (int k = 0; k < count; ++k) times_s.push_back(kInterval_s * k);
  return times_s;
}

/// The pose at the stamp, extrapolated from the middle by the last motion, without the middle's own error.
TEST(DistortionCovariance, IsWhatAMotionHalfAnIntervalOldLeaves) {
  const DistortionCovariance distortion = distortion_of(speeding_up, even_times(60));
  const double at_middle = distortion.variances(MotionSource::kConstantVelocity, swept(0.5), 0, 10)[0];
  EXPECT_GT(at_middle, 0);
  for (const double stamp_at : {0.0, 0.2, 0.7, 1.0}) {
    const double m = swept(stamp_at).middle_s;
    const double twist_mps = (path_m(0) - path_m(-kInterval_s)) / kInterval_s;  // the middle is at 0
    const double off_m = -m * twist_mps - path_m(-m);
    const SE3::Tangent variances =
        distortion.variances(MotionSource::kConstantVelocity, swept(stamp_at), 0, 10);
    EXPECT_NEAR(variances[0] - at_middle, off_m * off_m, 1e-3 * off_m * off_m) << stamp_at;
    EXPECT_LT(variances.tail<5>().norm(), 1e-20);
  }
}

/// Linear between odometry samples.
TEST(DistortionCovariance, IsWhatRowsLeaveBetweenThem) {
  const DistortionCovariance distortion = distortion_of(speeding_up, even_times(60));
  for (const double sample_interval_s : {0.02, 0.05, 0.1}) {
    constexpr int kSteps = 1000;
    double squares_m2 = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double t = sample_interval_s * ((k + 0.5) / kSteps - 0.5);
      squares_m2 +=
          std::pow(path_m(t) - path_m(sample_interval_s / 2), 2) / kSteps;  // the chord between two samples
    }
    EXPECT_NEAR(distortion.variances(MotionSource::kOdometry, swept(0), sample_interval_s, 10)[0], squares_m2,
                2e-3 * squares_m2);
  }
}

TEST(DistortionCovariance, OfReadingsOfAnEvenMotionOrOfScansWithoutTimesIsNone) {
  const DistortionCovariance distortion = distortion_of(speeding_up, even_times(60));
  EXPECT_TRUE(distortion.variances(MotionSource::kImu, swept(0), 0.1, 10).isZero(0));
  EXPECT_TRUE(distortion.variances(MotionSource::kConstantVelocity, {}, 0.1, 10).isZero(0));
  const auto even = [](double t) { return SE3({7 * t, 0, 0}, Eigen::Quaterniond::Identity()); };
  EXPECT_LT(
      distortion_of(even, even_times(60)).variances(MotionSource::kConstantVelocity, swept(0), 0, 10).norm(),
      1e-20);
}

/// A rotational distortion of points all around shifts their mean.
TEST(DistortionCovariance, OfTurnsIsOfThePositionToo) {
  const DistortionCovariance distortion = distortion_of(turning_up, even_times(60));
  const double range_m = 10, sample_interval_s = 0.1;
  const SE3::Tangent variances =
      distortion.variances(MotionSource::kOdometry, swept(0), sample_interval_s, range_m);
  constexpr int kSteps = 1000;
  double shift_m = 0;
  for (int k = 0; k < kSteps; ++k) {  // distortion linear in azimuth, with the model's rms
    const double azimuth = 2 * std::numbers::pi * ((k + 0.5) / kSteps - 0.5);
    const double off_rad = std::sqrt(3 * variances[5]) * azimuth / std::numbers::pi;
    shift_m += range_m * off_rad * std::sin(azimuth) / kSteps;
  }
  EXPECT_NEAR(variances[0], shift_m * shift_m, 1e-2 * shift_m * shift_m);
  EXPECT_NEAR(variances[1], variances[0], 1e-12);
  EXPECT_LT(variances.segment<3>(2).norm(), 1e-20);
  EXPECT_GT(variances[5], 1e-6);
}

/// Complete from the third scan on, and kept across the start of a new map.
TEST(DistortionCovariance, IsKnownFromTheThirdScanOn) {
  const auto variance = [](const DistortionCovariance& distortion) {
    return distortion.variances(MotionSource::kConstantVelocity, swept(0), 0, 10)[0];
  };
  EXPECT_EQ(variance(distortion_of(speeding_up, even_times(2))), 0);
  const double known = variance(distortion_of(speeding_up, even_times(60)));
  EXPECT_NEAR(variance(distortion_of(speeding_up, even_times(3))), known, 1e-9);
  DistortionCovariance distortion = distortion_of(speeding_up, even_times(60));
  distortion.start_new_map();
  distortion.add(Stamp::from_seconds(100), SE3({-500, 0, 0}, Eigen::Quaterniond::Identity()));
  EXPECT_NEAR(variance(distortion), known, 1e-9);
}

/// A duplicate scan after a very short time does not count as motion.
TEST(DistortionCovariance, OfABurstIsThatOfTheOthers) {
  std::vector<double> times_s = even_times(60);
  times_s.insert(times_s.begin() + 50, times_s[49] + 0.001);
  DistortionCovariance distortion(0.2, kInterval_s);
  for (const double t : times_s) {
    const double noise_m = std::remainder(1e4 * t, 3.0) / 150;
    distortion.add(Stamp::from_seconds(t), SE3({path_m(t) + noise_m, 0, 0}, Eigen::Quaterniond::Identity()));
  }
  EXPECT_LT(distortion.variances(MotionSource::kConstantVelocity, swept(0), 0, 10)[0],
            20 * distortion_of(speeding_up, even_times(60))
                     .variances(MotionSource::kConstantVelocity, swept(0), 0, 10)[0]);
}

Trajectory<SE3> rows_of(double from_s, double to_s) {
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; from_s + 0.01 * k <= to_s + 1e-9; ++k) {
    const double t = from_s + 0.01 * k;
    rows.push_back({Stamp::from_seconds(t), SE3::exp((SE3::Tangent() << t, 0, 0, 0, 0, 0.5 * t).finished())});
  }
  return Trajectory<SE3>(std::move(rows));
}

TEST(PriorFromOdometry, IsTheMotionOfItsSamples) {
  const auto rows = rows_of(0, 2);
  const ScanTimeSpan time{-0.02, 0.03, 0.08};
  const Stamp previous = Stamp::from_seconds(0.9), stamp = Stamp::from_seconds(1);
  const auto guess = prior_from_odometry(rows, previous, stamp, time, 0.15);
  ASSERT_TRUE(guess);
  EXPECT_LT((guess->T_previous_body->inverse() * rows.at(previous)->inverse() * *rows.at(stamp)).log().norm(),
            1e-12);
  for (std::size_t k = 0; k < guess->scan_motion.poses.size(); ++k) {
    const SE3 expected =
        SE3::exp(guess->scan_motion.time_of(k) * (SE3::Tangent() << 1, 0, 0, 0, 0, 0.5).finished());
    EXPECT_LT((guess->scan_motion.poses[k].inverse() * expected).log().norm(), 1e-8);
  }
  EXPECT_FALSE(prior_from_odometry(rows, std::nullopt, stamp, time, 0.15)->T_previous_body);
}

/// No prior for a sweep that odometry covers only in part.
TEST(PriorFromOdometry, IsOfWholeSweepsOnly) {
  const ScanTimeSpan time{-0.02, 0.03, 0.08};
  const Stamp stamp = Stamp::from_seconds(1);
  EXPECT_FALSE(prior_from_odometry({}, std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(prior_from_odometry(rows_of(0, 1.05), std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(prior_from_odometry(rows_of(0.99, 2), std::nullopt, stamp, time, 0.15));
  EXPECT_FALSE(prior_from_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.9), stamp, time, 0.15));
  EXPECT_TRUE(prior_from_odometry(rows_of(0.97, 1.09), Stamp::from_seconds(0.97), stamp, time, 0.15));
}

/// No prior across a gap in the odometry samples.
TEST(PriorFromOdometry, IsOfNoGapBetweenRows) {
  std::vector<StampedPose<SE3>> rows;
  for (const auto& row : rows_of(0, 4))
    if (row.stamp <= Stamp::from_seconds(1) || row.stamp >= Stamp::from_seconds(3)) rows.push_back(row);
  const Trajectory<SE3> odometry(rows);
  const ScanTimeSpan time{0, 0.05, 0.1};
  for (const double t : {0.85, 3.15})
    EXPECT_TRUE(
        prior_from_odometry(odometry, Stamp::from_seconds(t - 0.1), Stamp::from_seconds(t), time, 0.15));
  for (const double t : {0.95, 1.5, 3.05})
    EXPECT_FALSE(
        prior_from_odometry(odometry, Stamp::from_seconds(t - 0.1), Stamp::from_seconds(t), time, 0.15));
}

}  // namespace
}  // namespace radioslam

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "radioslam/geometry/so3.hpp"
#include "radioslam/radio/captures/csi_tracks.hpp"

namespace radioslam {
namespace {

constexpr double kStep_s = 0.1;

Trajectory<SE3> driven(double end_s, const std::function<SE3(double t_s)>& motion) {
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k * kStep_s <= end_s + 1e-9; ++k)
    poses.push_back({Stamp::from_seconds(k * kStep_s), motion(k * kStep_s)});
  return Trajectory<SE3>(std::move(poses));
}

SE3 at_x(double x_m) { return {{x_m, 0, 0}, Eigen::Quaterniond::Identity()}; }

TimeWindow all_of(const Trajectory<SE3>& odometry) { return {odometry.front().stamp, odometry.back().stamp}; }

/// Stands still for 5 s, drives 2 m at 0.5 m/s and stands still for 5 s.
Trajectory<SE3> stand_drive_stand() {
  return driven(14, [](double t_s) { return at_x(0.5 * std::clamp(t_s - 5, 0.0, 4.0)); });
}

TEST(CsiWindows, StillTimesAreThoseOfNoMotion) {
  const auto still = still_times(stand_drive_stand(), 0.005);
  ASSERT_EQ(still.size(), 2U);
  EXPECT_NEAR(still[0].begin.seconds(), 0, 1e-9);
  EXPECT_NEAR(still[0].end.seconds(), 5, 1e-9);
  EXPECT_NEAR(still[1].begin.seconds(), 9, 1e-9);
  EXPECT_NEAR(still[1].end.seconds(), 14, 1e-9);
}

TEST(CsiWindows, NothingCreepsBeyondItsReach) {
  const auto creeping = driven(20, [](double t_s) { return at_x(0.002 * t_s); });
  const auto still = still_times(creeping, 0.005);
  ASSERT_GE(still.size(), 8U);
  for (const TimeWindow& window : still) {
    const double moved_m =
        (creeping.at(window.end)->translation() - creeping.at(window.begin)->translation()).norm();
    EXPECT_LE(moved_m, 0.005 + 1e-12) << "relative to the begin of the window, not to the previous pose";
  }
}

TEST(CsiWindows, OfADriveWithoutAStopThereIsNoStillTime) {
  EXPECT_TRUE(still_times(driven(5, [](double t_s) { return at_x(t_s); }), 0.005).empty());
  EXPECT_TRUE(still_times({}, 0.005).empty());
}

TEST(CsiWindows, WindowsCoverThePathEvenlyWithoutOverlap) {
  const auto odometry = driven(17, [](double t_s) { return at_x(0.2 * t_s); });  // 3.4 m
  const auto windows = path_windows(odometry, all_of(odometry), 1, 0.15);
  ASSERT_EQ(windows.size(), 3U);
  EXPECT_EQ(windows.front().begin, odometry.front().stamp);
  EXPECT_EQ(windows.back().end, odometry.back().stamp);
  for (std::size_t k = 0; k < 3; ++k) {
    if (k > 0) {
      EXPECT_EQ(windows[k].begin, windows[k - 1].end);
    }
    const double path_m =
        odometry.at(windows[k].end)->translation().x() - odometry.at(windows[k].begin)->translation().x();
    EXPECT_NEAR(path_m, 3.4 / 3, 0.021) << "one pose every 2 cm";
  }
}

TEST(CsiWindows, WindowsKeepToTheirTime) {
  const auto odometry = driven(20, [](double t_s) { return at_x(0.2 * t_s); });
  const TimeWindow during{Stamp::from_seconds(3), Stamp::from_seconds(9)};  // 1.2 m
  const auto windows = path_windows(odometry, during, 1, 0.15);
  ASSERT_EQ(windows.size(), 1U);
  EXPECT_GE(windows[0].begin, during.begin);
  EXPECT_LE(windows[0].end, during.end);
}

TEST(CsiWindows, APathTooShortHasNoWindows) {
  const auto odometry = driven(10, [](double t_s) { return at_x(0.01 * t_s); });
  EXPECT_TRUE(path_windows(odometry, all_of(odometry), 1, 0.15).empty());
  EXPECT_EQ(path_windows(odometry, all_of(odometry), 1, 0.05).size(), 1U) << "shorter than requested";
  const TimeWindow later{Stamp::from_seconds(50), Stamp::from_seconds(60)};
  EXPECT_TRUE(path_windows(odometry, later, 1, 0.15).empty());
}

TEST(CsiWindows, ACircleIsAsLongAsItsPathNotAsItsExtent) {
  const auto odometry = driven(10, [](double t_s) {
    const double angle = 2 * std::numbers::pi * t_s / 10;
    return SE3({std::cos(angle), std::sin(angle), 0}, so3_exp({0, 0, angle}));
  });
  EXPECT_EQ(path_windows(odometry, all_of(odometry), 1, 0.15).size(), 6U);
}

TEST(CsiWindows, TurnsCountInEitherDirectionAndWithoutMotion) {
  const auto there_and_back = driven(10, [](double t_s) {
    return SE3({0, 0, 0}, so3_exp({0, 0, t_s < 5 ? t_s : 10 - t_s}));
  });
  const auto turns = turns_of(there_and_back, 1.5);
  ASSERT_EQ(turns.size(), 6U) << "ten radians in total";
  for (const TimeWindow& turn : turns) EXPECT_NEAR(seconds_between(turn.begin, turn.end), 1.5, 0.11);
  for (std::size_t k = 1; k < turns.size(); ++k) EXPECT_EQ(turns[k].begin, turns[k - 1].end);
  EXPECT_TRUE(turns_of(stand_drive_stand(), 1.5).empty());
}

}  // namespace
}  // namespace radioslam

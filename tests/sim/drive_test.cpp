#include "radioslam/sim/motion/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace radioslam {
namespace {

TEST(Route, FollowsOpenLanesWithoutTurningBack) {
  const LaneGrid lanes(LaneGridParams{}, Rng(3));
  const auto route = draw_route(lanes, 7, 600, Rng(4));
  EXPECT_EQ(route.front(), 7U);
  double length_m = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const auto& next = lanes.neighbours(route[i - 1]);
    EXPECT_TRUE(std::find(next.begin(), next.end(), route[i]) != next.end());
    EXPECT_TRUE(i < 2 || route[i] != route[i - 2]);
    length_m += (lanes.crossing(route[i]) - lanes.crossing(route[i - 1])).norm();
  }
  EXPECT_GE(length_m, 600);
}

TEST(Route, ComesBackToLanes) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const LaneGrid lanes(LaneGridParams{}, Rng(seed));
    const auto route = draw_route(lanes, 0, 600, Rng(seed));
    std::map<std::pair<std::size_t, std::size_t>, int> uses;
    for (std::size_t i = 1; i < route.size(); ++i) ++uses[std::minmax(route[i - 1], route[i])];
    int again = 0;
    for (const auto& [lane, count] : uses) again += count - 1;
    EXPECT_GE(again, 3) << "seed " << seed;
    EXPECT_GE(uses.size(), lanes.lane_count() / 2) << "seed " << seed;
  }
}

DriveParams tidy() {
  DriveParams params;
  params.sigma_wander_m = 0;
  params.corner_radius_m = 2;
  return params;
}

TEST(Drive, TakesACornerOnAnArc) {
  const Drive drive({{0, 0}, {10, 0}, {10, 10}}, tidy(), Rng(1));
  const double arc_m = std::numbers::pi;  // a quarter circle of radius 2
  EXPECT_NEAR(drive.length_m(), 8 + arc_m + 8, 1e-12);
  const SE2 middle = drive.pose_at(8 + arc_m / 2);
  EXPECT_NEAR(middle.translation().x(), 8 + 2 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(middle.translation().y(), 2 - 2 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(middle.angle(), std::numbers::pi / 4, 1e-12);
  const SE2 end = drive.pose_at(drive.length_m());
  EXPECT_NEAR((end.translation() - Eigen::Vector2d(10, 10)).norm(), 0, 1e-12);
  EXPECT_NEAR(end.angle(), std::numbers::pi / 2, 1e-12);
}

TEST(Drive, SharpensCornersBetweenShortLanes) {
  DriveParams params = tidy();
  params.corner_radius_m = 4;
  const Drive drive({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, params, Rng(1));
  const SE2 end = drive.pose_at(drive.length_m());
  EXPECT_NEAR((end.translation() - Eigen::Vector2d(0, 2)).norm(), 0, 1e-12);
  for (double way = 0; way < drive.length_m(); way += 0.01) {
    const auto p = drive.pose_at(way).translation();
    EXPECT_TRUE(p.x() <= 2 + 1e-12 && p.y() >= -1e-12 && p.y() <= 2 + 1e-12);
  }
}

TEST(Drive, HeadsWhereItGoes) {
  const Drive drive({{0, 0}, {30, 0}, {30, 30}, {0, 30}}, DriveParams{}, Rng(5));
  const double step_m = 1e-4;
  for (double way = step_m; way + step_m < drive.length_m(); way += 0.37) {
    const Eigen::Vector2d moved =
        drive.pose_at(way + step_m).translation() - drive.pose_at(way - step_m).translation();
    const double direction = std::atan2(moved.y(), moved.x());
    EXPECT_NEAR(wrap_angle(direction - drive.pose_at(way).angle()), 0, 1e-4);
  }
}

TEST(Drive, WandersByTheSigmaAskedFor) {
  DriveParams params;
  params.sigma_wander_m = 0.3;
  const Drive drive({{0, 0}, {20000, 0}}, params, Rng(6));
  double squares = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) squares += std::pow(drive.pose_at(i).translation().y(), 2);
  EXPECT_NEAR(std::sqrt(squares / n), 0.3, 0.01);
}

}  // namespace
}  // namespace radioslam

#include "radioslam/rendezvous/adaptive_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

constexpr double kMaxStep_m = 2;

Eigen::Vector2d step(AdaptiveWalk& walk, const SE2& raw, double esnr_db,
                     const std::vector<ArrivalPath>& arrivals, ObstacleMemory& obstacles,
                     const std::optional<ExpectedDirection>& expected = {}) {
  return *walk.next(raw, esnr_db, arrivals, expected, kMaxStep_m, obstacles) - raw.translation();
}

TEST(AdaptiveWalk, StepsAlongTheStrongestArrivalByTheSquareOfTheDiscrepancy) {
  RendezvousParams params;
  params.walk = "strongest";
  AdaptiveWalk walk(params);
  ObstacleMemory obstacles;
  walk.begin(25);
  const SE2 raw({3, 4}, M_PI / 2);
  // w = 3 / 25 = 0.12, (w / 0.1)^2 = 1.44 m
  const Eigen::Vector2d moved = step(walk, raw, 22, {{0, 0.1, -3}, {0.5, 0.1, -9}}, obstacles);
  EXPECT_NEAR(moved.norm(), 1.44, 1e-9);
  EXPECT_NEAR(moved.y(), 1.44, 1e-9);
  EXPECT_NEAR(step(walk, raw, 2, {{0, 0.1, 0}}, obstacles).norm(), kMaxStep_m, 1e-9);
}

TEST(AdaptiveWalk, GoesOnWhereThereIsSignalEnough) {
  const RendezvousParams params;
  AdaptiveWalk walk(params);
  ObstacleMemory obstacles;
  walk.begin(25);
  EXPECT_NEAR(step(walk, SE2(), 40, {{0, 0.1, 0}}, obstacles).norm(), params.min_step_m, 1e-9);
}

TEST(AdaptiveWalk, TakesTheArrivalThatTheEstimatesSpeakForIfAsked) {
  AdaptiveWalk walk(RendezvousParams{});
  ObstacleMemory obstacles;
  walk.begin(25);
  const std::vector<ArrivalPath> arrivals{{1.2, 0.1, -3}, {-0.1, 0.1, -5}};  // a reflection is the strongest
  EXPECT_GT(step(walk, SE2(), 10, arrivals, obstacles).y(), 1);
  EXPECT_LT(std::abs(step(walk, SE2(), 10, arrivals, obstacles, ExpectedDirection{0, 0.2}).y()), 0.5);
}

// A wall across the way, known only as far as it was seen from where the robot is.
TEST(AdaptiveWalk, GetsRoundAWall) {
  const Eigen::Vector2d goal(20, 0);
  AdaptiveWalk walk(RendezvousParams{});
  ObstacleMemory obstacles;
  walk.begin(25);
  SE2 pose;
  const auto wall_at = [](double y) { return y > -6 && y < 3; };  // at x = 8
  for (int k = 0; k < 60 && (goal - pose.translation()).norm() > 2; ++k) {
    for (const double azimuth : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      const double heading = pose.angle() + azimuth, reach = (8 - pose.translation().x()) / std::cos(heading);
      if (reach > 0 && reach < 3 && wall_at(pose.translation().y() + reach * std::sin(heading)))
        obstacles.add(pose, {0, azimuth, reach});
    }
    const Eigen::Vector2d offset = pose.inverse() * goal;
    const double esnr_db = 20 - offset.norm();
    const Eigen::Vector2d moved =
        step(walk, pose, esnr_db, {{std::atan2(offset.y(), offset.x()), 0.1, 0}}, obstacles);
    const Eigen::Vector2d from = pose.translation();
    Eigen::Vector2d to = from + moved;
    const bool crosses =
        from.x() < 8 && to.x() >= 8 && wall_at(from.y() + (8 - from.x()) / moved.x() * moved.y());
    if (crosses) to = from + std::max(0.0, (7.7 - from.x()) / moved.x()) * moved;
    pose = SE2(to, std::atan2(moved.y(), moved.x()));
  }
  EXPECT_LT((goal - pose.translation()).norm(), 2.5);
}

}  // namespace
}  // namespace radioslam

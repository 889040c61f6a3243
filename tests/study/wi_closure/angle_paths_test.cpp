#include "radioslam/study/wi_closure/angle_paths.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(AnglePaths, TheLikeliestOfAnAcceptedAngleCounts) {
  AnglePaths angle{3, 1, {0.2, 0.7, 0.1}, true};
  EXPECT_EQ(angle.likeliest(), 1U);
  EXPECT_TRUE(angle.finds_direct());
  angle.direct_path = 0;
  EXPECT_FALSE(angle.finds_direct());
  angle.direct_path = kNoDirectPath;
  EXPECT_FALSE(angle.has_direct());
  EXPECT_FALSE(angle.finds_direct());
  angle = {3, 1, {0.2, 0.25, 0.1}, false};
  EXPECT_FALSE(angle.finds_direct());
  EXPECT_FALSE(AnglePaths{}.likeliest());
}

TEST(AnglePaths, EveryAngleHasTheOutcomeOfItsTime) {
  Mission mission;
  Truth truth;
  RunResult result;
  result.robots.resize(2);
  for (RobotResult& robot : result.robots)
    robot.estimate = Trajectory<SE3>({{Stamp::from_seconds(0), SE3()}, {Stamp::from_seconds(10), SE3()}});
  for (const double t_s : {3.0, 4.0, 12.0}) {
    AoaMeasurement& angle = mission.aoa_measurements.emplace_back();
    angle.stamp = Stamp::from_seconds(t_s);
    angle.receiver = RobotIndex(0);
    angle.transmitter.robot = RobotIndex(1);
    angle.paths.resize(2);
    truth.direct_paths.push_back(1);
    ClosureResult& closure = result.closures.emplace_back();
    closure.kind = ClosureKind::kAoa;
    closure.robot_i = RobotIndex(0);
    closure.robot_j = RobotIndex(1);
    closure.stamp_i = closure.stamp_j = Stamp::from_seconds(t_s < 10 ? 0 : 10);
    closure.path_weights = {1 - t_s / 20, t_s / 20};
  }
  result.closures[1].status = ClosureStatus::kRejected;
  const auto angles = compare_angle_paths(result, mission, truth);
  ASSERT_EQ(angles.size(), 3U);
  EXPECT_EQ(angles[0].weights, result.closures[0].path_weights);
  EXPECT_EQ(angles[1].weights, result.closures[1].path_weights);
  EXPECT_FALSE(angles[1].accepted);
  EXPECT_TRUE(angles[2].finds_direct());
  mission.aoa_measurements.front().transmitter.robot = RobotIndex(0);
  EXPECT_TRUE(compare_angle_paths(result, mission, truth).front().weights.empty());
}

}  // namespace
}  // namespace radioslam

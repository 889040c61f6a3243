#include "radioslam/geometry/trajectory.hpp"

#include <gtest/gtest.h>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {
namespace {

Trajectory<SE2> quarter_turn() {
  // Half a metre of radius, a quarter of a circle in two seconds, then straight on.
  return Trajectory<SE2>({{Stamp::from_seconds(1), SE2()},
                          {Stamp::from_seconds(3), SE2({0.5, 0.5}, 1.5707963267948966)},
                          {Stamp::from_seconds(4), SE2({0.5, 1.5}, 1.5707963267948966)}});
}

TEST(Trajectory, InterpolatesAlongTheArc) {
  const auto pose = quarter_turn().at(Stamp::from_seconds(2));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->angle(), 0.7853981633974483, 1e-12);
  EXPECT_NEAR(pose->translation().x(), 0.5 * std::sin(0.7853981633974483), 1e-12);
  EXPECT_NEAR(pose->translation().y(), 0.5 * (1 - std::cos(0.7853981633974483)), 1e-12);
}

TEST(Trajectory, GivesItsOwnPosesAtItsOwnStamps) {
  const auto trajectory = quarter_turn();
  for (const auto& [stamp, pose] : trajectory)
    EXPECT_LT((trajectory.at(stamp)->inverse() * pose).log().norm(), 1e-12);
}

TEST(Trajectory, IsUndefinedOutsideItsTime) {
  EXPECT_FALSE(quarter_turn().at(Stamp::from_seconds(0.999)));
  EXPECT_FALSE(quarter_turn().at(Stamp::from_seconds(4.001)));
  EXPECT_FALSE(Trajectory<SE3>().at(Stamp{}));
  const Trajectory<SE3> single({{Stamp{5}, SE3()}});
  EXPECT_TRUE(single.at(Stamp{5}));
  EXPECT_FALSE(single.at(Stamp{6}));
}

TEST(TrajectoryDeathTest, RefusesTimeThatRunsBackwards) {
  EXPECT_DEATH(Trajectory<SE2>({{Stamp{2}, SE2()}, {Stamp{2}, SE2()}}), "must increase");
}

TEST(Stamp, KeepsNanosecondsOfTheUnixEpoch) {
  EXPECT_DOUBLE_EQ(seconds_between(Stamp{1574244259025000001}, Stamp{1574244259025000002}), 1e-9);
}

}  // namespace
}  // namespace radioslam

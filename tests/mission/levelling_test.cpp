#include <gtest/gtest.h>

#include "mission/phone_walks.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam {
namespace {

using test::KnownWalk;
using test::recorded;

class Held : public ::testing::TestWithParam<double> {
 protected:
  /// A phone whose screen is tilted back.
  KnownWalk walk() const {
    KnownWalk walk;
    walk.R_hand_device = Eigen::AngleAxisd(GetParam(), Eigen::Vector3d::UnitX());
    return walk;
  }
};
INSTANTIATE_TEST_SUITE_P(LevelMotion, Held, ::testing::Values(0.0, 0.6, 1.2));

TEST_P(Held, FollowsTurnsThroughMoreThanAFullCircle) {
  auto walk = this->walk();
  walk.heading_rad = [](double t) { return 0.5 * t + std::sin(t); };
  const auto level = level_motion(recorded(walk), {});
  ASSERT_EQ(level.size(), 1501U);
  for (std::size_t i = 0; i < level.size(); ++i)
    EXPECT_NEAR(level[i].heading_rad, walk.heading_rad(0.02 * static_cast<double>(i)), 2e-3);
}

TEST_P(Held, GivesTheVerticalAcceleration) {
  auto walk = this->walk();
  walk.vertical_mps2 = test::steps_between(5, 25, 1.8, 3);
  const auto level = level_motion(recorded(walk), {});
  for (std::size_t i = 0; i < level.size(); ++i)
    EXPECT_NEAR(level[i].vertical_mps2, walk.vertical_mps2(0.02 * static_cast<double>(i)), 1e-6);
}

TEST(LevelMotion, AGyroscopeBiasTiltsLittleAndTurnsByItsVerticalPart) {
  KnownWalk walk;
  walk.duration_s = 60;
  walk.gyroscope_bias_radps = {0.01, -0.01, 0.002};
  const auto level = level_motion(recorded(walk), {});
  EXPECT_NEAR(level.back().heading_rad, 60 * 0.002, 0.01);
  EXPECT_NEAR(level.back().vertical_mps2, 0, 0.02);  // 9.81 (1 - cos(0.03 sqrt 2)) = 0.009
}

TEST(LevelMotion, TheTwoSensorsMayHaveDifferentStamps) {
  KnownWalk walk;
  walk.heading_rad = [](double t) { return 0.3 * t; };
  walk.vertical_mps2 = [](double t) { return 0.1 * t; };
  auto motion = recorded(walk);
  for (auto& reading : motion.angular_rate_radps) reading.stamp.ns += 7'000'000;
  const auto level = level_motion(motion, {});
  EXPECT_NEAR(level[1000].vertical_mps2, walk.vertical_mps2(20.007), 1e-6);
}

TEST(LevelMotion, IsEmptyWithoutEitherSensor) {
  auto motion = recorded({});
  motion.specific_force_mps2.clear();
  EXPECT_TRUE(level_motion(motion, {}).empty());
  motion = recorded({});
  motion.angular_rate_radps.clear();
  EXPECT_TRUE(level_motion(motion, {}).empty());
}

}  // namespace
}  // namespace radioslam

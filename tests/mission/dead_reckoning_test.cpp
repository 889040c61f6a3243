#include "radioslam/mission/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include "mission/phone_walks.hpp"

namespace radioslam {
namespace {

using test::KnownWalk;
using test::kPi;
using test::recorded;
using test::walk_stamp;

/// Ten seconds north-east, a left turn, ten seconds north-west; noisy sensors and a biased gyroscope.
KnownWalk hook() {
  KnownWalk walk;
  walk.duration_s = 24;
  walk.heading_rad = test::turn_at(11, kPi / 4, 3 * kPi / 4);
  const auto first = test::steps_between(1, 11, 2, 3);
  const auto second = test::steps_between(12, 22, 2, 3);
  walk.vertical_mps2 = [=](double t) { return first(t) + second(t); };
  walk.gyroscope_bias_radps = {0.001, -0.001, 0.0005};
  walk.sigma_force_mps2 = 0.3;
  walk.sigma_rate_radps = 0.02;
  return walk;
}

DeadReckoning reckon(const PhoneMotion& motion, double begin_s = 0, double end_s = 24) {
  return dead_reckon(motion, walk_stamp(begin_s), walk_stamp(end_s), {});
}

TEST(ReckonWalk, FollowsAHookInEastNorthUp) {
  const auto walk = reckon(recorded(hook()));
  ASSERT_EQ(walk.steps.size(), 40U);
  double length = 0;
  for (const auto& step : walk.steps) length += step.length_m;
  EXPECT_NEAR(length / 40, 0.6, 0.1);
  const Eigen::Vector3d corner = walk.odometry.at(walk_stamp(11.5))->translation();
  const Eigen::Vector3d end = walk.odometry.back().pose.translation();
  EXPECT_LT((corner - length / 2 * Eigen::Vector3d(std::sqrt(0.5), std::sqrt(0.5), 0)).norm(), 0.4);
  EXPECT_LT((end - length * Eigen::Vector3d(0, std::sqrt(0.5), 0)).norm(), 0.4);
  EXPECT_NEAR(walk.odometry.front().pose.yaw(), kPi / 4, 0.03);
  EXPECT_NEAR(walk.odometry.back().pose.yaw(), 3 * kPi / 4, 0.03);
}

TEST(ReckonWalk, CoversTheWholeLogAndStartsAtTheOrigin) {
  const auto walk = reckon(recorded(hook()), -0.5, 30);
  EXPECT_EQ(walk.odometry.front().stamp, walk_stamp(-0.5));
  EXPECT_EQ(walk.odometry.back().stamp, walk_stamp(30));
  EXPECT_EQ(walk.odometry.front().pose.translation(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(walk.odometry.at(walk_stamp(0))->translation(), Eigen::Vector3d(0, 0, 0));
}

TEST(ReckonWalk, DoesNotMoveDuringAPause) {
  KnownWalk pause;
  const auto before = test::steps_between(2, 10, 2, 3);
  const auto after = test::steps_between(20, 26, 2, 3);
  pause.vertical_mps2 = [=](double t) { return before(t) + after(t); };
  const auto walk = reckon(recorded(pause), 0, 30);
  EXPECT_LT(
      (walk.odometry.at(walk_stamp(19))->translation() - walk.odometry.at(walk_stamp(11))->translation())
          .norm(),
      1e-9);
  EXPECT_GT(walk.odometry.at(walk_stamp(10))->translation().x(), 6);
}

TEST(ReckonWalk, ARotatedCompassRotatesThePath) {
  auto turned = hook();
  turned.compass_error_rad = [](double) { return 1.0; };
  const auto plain = reckon(recorded(hook())), rotated = reckon(recorded(turned));
  ASSERT_EQ(plain.odometry.size(), rotated.odometry.size());
  const SE3 turn = lift(SE2({0, 0}, 1));
  for (std::size_t i = 0; i < plain.odometry.size(); ++i)
    EXPECT_LT(((turn * plain.odometry[i].pose).inverse() * rotated.odometry[i].pose).log().norm(), 1e-6);
}

TEST(ReckonWalk, ATiltedPhoneGivesTheSamePath) {
  auto tilted = hook();
  tilted.R_hand_device = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX());
  const auto flat = reckon(recorded(hook())), leaning = reckon(recorded(tilted));
  EXPECT_LT((flat.odometry.back().pose.translation() - leaning.odometry.back().pose.translation()).norm(),
            0.5);
}

TEST(ReckonWalk, WithoutACompassTheStartsHeadingIsZero) {
  auto motion = recorded(hook());
  motion.orientation.clear();
  const auto walk = reckon(motion);
  EXPECT_FALSE(walk.compass);
  EXPECT_EQ(walk.odometry.front().pose.yaw(), 0);
  EXPECT_NEAR(walk.odometry.back().pose.yaw(), kPi / 2, 0.05);
}

TEST(ReckonWalk, WithoutSensorsTheWalkerDoesNotMove) {
  const auto walk = reckon({});
  EXPECT_TRUE(walk.steps.empty());
  ASSERT_EQ(walk.odometry.size(), 2U);
  EXPECT_EQ(walk.odometry.back().pose.translation(), Eigen::Vector3d(0, 0, 0));
}

TEST(ReckonWalkDeathTest, BeginMustPrecedeEnd) { EXPECT_DEATH(reckon({}, 1, 1), "must precede end"); }

}  // namespace
}  // namespace radioslam

#include "radioslam/mission/keyframe_motion.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

/// A sample every half second.
Robot wandering_robot() {
  Rng rng(5);
  Robot robot;
  std::vector<StampedPose<SE3>> rows{{Stamp{}, SE3()}};
  for (int k = 1; k < 60; ++k)
    rows.push_back(
        {Stamp::from_seconds(0.5 * k),
         rows.back().pose * SE3::exp((SE3::Tangent() << rng.uniform(0, 0.3), 0, rng.normal(0, 0.02),
                                      rng.normal(0, 0.02), 0, rng.normal(0, 0.1))
                                         .finished())});
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.odometry_noise.sigma_scale = 0.03;
  return robot;
}

/// In whatever order it is asked, it is odometry_between but for the floor of an edge's variance.
TEST(KeyframeMotion, IsTheOdometrySinceTheKeyframeBefore) {
  const Robot robot = wandering_robot();
  std::vector<Stamp> keyframes;
  for (const double s : {0.0, 4.2, 9.0, 20.0}) keyframes.push_back(Stamp::from_seconds(s));
  KeyframeMotion<SE3> motion(robot, keyframes);
  for (const double s : {0.0, 0.3, 0.7, 4.1, 4.2, 8.9, 25.0, 25.0, 24.3, 3.0, 3.2}) {
    const Stamp stamp = Stamp::from_seconds(s);
    const auto found = motion.at(stamp);
    EXPECT_EQ(found.keyframe, keyframes.size() - 1 - (s < 4.2 ? 3 : s < 9 ? 2 : s < 20 ? 1 : 0)) << s;
    const auto expected = odometry_between<SE3>(robot, keyframes[found.keyframe], stamp);
    EXPECT_LT((found.T_keyframe_body.pose.inverse() * expected.pose).log().norm(), 1e-9) << s;
    SE3::Jacobian covariance = expected.covariance;
    covariance.diagonal() -= min_edge_variance<SE3>();
    EXPECT_LT((found.T_keyframe_body.covariance - covariance).norm(), 1e-12) << s;
  }
}

TEST(KeyframeMotion, IsExactAtAKeyframe) {
  const Robot robot = wandering_robot();
  const std::vector<Stamp> keyframes{Stamp{}, Stamp::from_seconds(7.3)};
  KeyframeMotion<SE2> motion(robot, keyframes);
  const auto found = motion.at(keyframes[1]);
  EXPECT_EQ(found.keyframe, 1U);
  EXPECT_EQ(found.T_keyframe_body.pose.log().norm(), 0);
  EXPECT_EQ(found.position_m2(), 0);
  EXPECT_EQ(found.rotation_rad2(), 0);
}

}  // namespace
}  // namespace radioslam

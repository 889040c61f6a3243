#include "radioslam/sim/motion/spline_motion.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

std::vector<SE3> outlier_controls(Rng rng) {
  std::vector<SE3> controls;
  SE3 pose;
  for (int k = 0; k < 12; ++k) {
    SE3::Tangent step;
    for (int i = 0; i < 6; ++i) step(i) = rng.normal(0, 0.5);
    pose = pose * SE3::exp(step);
    controls.push_back(pose);
  }
  return controls;
}

TEST(SplineMotion, ItsDerivativesAreThoseOfItsPoses) {
  const SplineMotion motion(outlier_controls(Rng(4)), 0.3);
  EXPECT_NEAR(motion.end_s(), 9 * 0.3, 1e-12);
  constexpr std::int64_t kStep_ns = 100000;
  constexpr double kStep_s = 1e-4;
  for (std::int64_t ns = 2 * kStep_ns; ns < Stamp::from_seconds(motion.end_s()).ns - kStep_ns;
       ns += 7777777) {
    const MotionState now = motion.at({ns});
    const SE3 before = motion.pose_at({ns - kStep_ns}), after = motion.pose_at({ns + kStep_ns});
    const Eigen::Vector3d moved = after.translation() - before.translation();
    const Eigen::Vector3d bent =
        after.translation() + before.translation() - 2 * now.T_common_body.translation();
    EXPECT_LT((moved / (2 * kStep_s) - now.velocity_mps).norm(), 1e-5) << ns;
    EXPECT_LT((bent / (kStep_s * kStep_s) - now.acceleration_mps2).norm(), 0.05) << ns;
    const Eigen::Vector3d turned = so3_log(before.rotation().conjugate() * after.rotation());
    EXPECT_LT((turned / (2 * kStep_s) - now.angular_rate_radps).norm(), 1e-5) << ns;
  }
}

TEST(SplineMotion, VelocityAccelerationAndRateDoNotJumpAtKnots) {
  const SplineMotion motion(outlier_controls(Rng(9)), 0.3);
  for (int knot = 1; knot < 9; ++knot) {
    const Stamp at = Stamp::from_seconds(0.3 * knot);
    const MotionState before = motion.at({at.ns - 1}), after = motion.at({at.ns + 1});
    EXPECT_LT((after.velocity_mps - before.velocity_mps).norm(), 1e-6);
    EXPECT_LT((after.acceleration_mps2 - before.acceleration_mps2).norm(), 1e-5);
    EXPECT_LT((after.angular_rate_radps - before.angular_rate_radps).norm(), 1e-6);
  }
}

TEST(SplineMotion, EvenControlsMakeAnEvenMotion) {
  std::vector<SE3> straight, turning;
  for (int k = 0; k < 8; ++k) {
    straight.push_back(SE3({0.5 * k, 1, 2}, Eigen::Quaterniond::Identity()));
    turning.push_back(SE3({0, 0, 0}, so3_exp({0, 0, 0.2 * k})));
  }
  const MotionState line = SplineMotion(straight, 0.25).at(Stamp::from_seconds(0.6));
  EXPECT_LT((line.T_common_body.translation() - Eigen::Vector3d(0.5 + 1.2, 1, 2)).norm(), 1e-12);
  EXPECT_LT((line.velocity_mps - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT(line.acceleration_mps2.norm(), 1e-12);
  const MotionState turn = SplineMotion(turning, 0.25).at(Stamp::from_seconds(0.6));
  EXPECT_NEAR(turn.T_common_body.yaw(), 0.2 + 0.48, 1e-12);
  EXPECT_LT((turn.angular_rate_radps - Eigen::Vector3d(0, 0, 0.8)).norm(), 1e-12);
}

}  // namespace
}  // namespace radioslam

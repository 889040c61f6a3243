#include "radioslam/sim/motion/smooth_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

/// 60 s along an arc of 20 m radius, 1 m/s.
Trajectory<SE3> arc() {
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k <= 600; ++k)
    poses.push_back({Stamp::from_seconds(0.1 * k), lift(SE2::exp({0.1 * k, 0, 0.005 * k}))});
  return Trajectory<SE3>(std::move(poses));
}

TEST(SmoothRide, RestsThenTakesUpSpeed) {
  SmoothMotionParams params;
  params.rest_s = 3;
  params.accelerate_s = 4;
  const SplineMotion ride = smooth_motion(arc(), params, Rng(1));
  for (const double t_s : {0.0, 1.0, 2.7}) {
    const MotionState state = ride.at(Stamp::from_seconds(t_s));
    EXPECT_LT(state.T_common_body.log().norm(), 1e-12);
    EXPECT_EQ(state.velocity_mps.norm(), 0);
    EXPECT_EQ(state.angular_rate_radps.norm(), 0);
  }
  EXPECT_NEAR(ride.at(Stamp::from_seconds(5)).velocity_mps.norm(), 0.5, 0.02);
  EXPECT_NEAR(ride.at(Stamp::from_seconds(8)).velocity_mps.norm(), 1, 1e-3);
  EXPECT_NEAR(ride.at(Stamp::from_seconds(8)).angular_rate_radps.z(), 0.05, 1e-3);
  // Half of the acceleration time is lost, and two knots at the end.
  EXPECT_NEAR(ride.end_s(), 60 + 3 + 2 - 2 * params.knot_s, params.knot_s);
}

TEST(SmoothRide, KeepsToItsPath) {
  SmoothMotionParams params;
  params.speed_swing = 0.5;
  const SplineMotion ride = smooth_motion(arc(), params, Rng(2));
  const Eigen::Vector3d centre(0, 20, 0);
  constexpr double kOff_m = 1.5 * 1.5 / 20 * 0.25 * 0.25 / 6;  // a sixth of acceleration and knot squared
  double slowest = 10, fastest = 0;
  for (double t_s = 6; t_s < ride.end_s(); t_s += 0.05) {
    const MotionState state = ride.at(Stamp::from_seconds(t_s));
    EXPECT_NEAR((state.T_common_body.translation() - centre).norm(), 20, kOff_m);
    const Eigen::Vector3d ahead = state.T_common_body.rotate(Eigen::Vector3d::UnitX());
    EXPECT_GT(ahead.dot(state.velocity_mps), 0.999 * state.velocity_mps.norm());
    slowest = std::min(slowest, state.velocity_mps.norm());
    fastest = std::max(fastest, state.velocity_mps.norm());
  }
  EXPECT_GT(slowest, 0.49);
  EXPECT_LT(slowest, 0.8);
  EXPECT_LT(fastest, 1.51);
  EXPECT_GT(fastest, 1.2);
}

TEST(SmoothRide, SwaysAsMuchAsStated) {
  SmoothMotionParams params;
  params.sway_rad = 0.02;
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SplineMotion ride = smooth_motion(arc(), params, Rng(seed));
    for (double t_s = 0; t_s < ride.end_s(); t_s += 0.5, ++count) {
      const Eigen::Vector3d up =
          ride.pose_at(Stamp::from_seconds(t_s)).rotation().conjugate() * Eigen::Vector3d::UnitZ();
      squares += up.head<2>().squaredNorm() / 2;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.004);
  EXPECT_EQ(smooth_motion(arc(), params, Rng(3)).pose_at(Stamp::from_seconds(9)).translation(),
            smooth_motion(arc(), params, Rng(3)).pose_at(Stamp::from_seconds(9)).translation());
}

TEST(SmoothRide, RestsAtASinglePose) {
  const SE3 there({1, 2, 3}, Eigen::Quaterniond::Identity());
  const SplineMotion ride = smooth_motion(Trajectory<SE3>({{Stamp{}, there}}), {}, Rng(1));
  EXPECT_LT((ride.pose_at(Stamp::from_seconds(ride.end_s())).inverse() * there).log().norm(), 1e-12);
}

}  // namespace
}  // namespace radioslam

#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/marginals.hpp"

namespace radioslam {
namespace {

constexpr int kSteps = 400, kUnseen = 200;

/// A metre per second; nothing measured the step before row kUnseen, of `sigma_m` and any heading.
Mission mission_with_unseen_motion(double sigma_m) {
  Mission mission;
  mission.robots.resize(1);
  Robot& robot = mission.robots[0];
  robot.id = "a";
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; k <= kSteps; ++k) {
    rows.push_back({Stamp::from_seconds(k), lift(SE2({double(k), 0}, 0))});
    if (k == 0) continue;
    const SE3::Jacobian covariance = k == kUnseen
                                         ? isotropic(sigma_m * sigma_m, std::numbers::pi * std::numbers::pi)
                                         : isotropic(1e-5, 1e-7);
    robot.odometry_noise.steps.push_back({rows[rows.size() - 2].stamp, rows.back().stamp, covariance});
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  return mission;
}

TEST(WidenByUnknownMotions, StatesWhatMayHaveHappened) {
  for (const double sigma_m : {5.0, 100.0, 1000.0}) {
    const Mission mission = mission_with_unseen_motion(sigma_m);
    const auto joint = build_joint_graph<SE3>(mission, {}, {});
    const auto marginals = Marginals<SE3>::compute(joint.team.graph);
    ASSERT_TRUE(marginals) << sigma_m;
    std::vector<RobotResult> robots(1);
    for (const PoseId pose : joint.robots[0].poses) {
      robots[0].sigma_position_m.push_back(sigma_of(marginals->pose(pose).topLeftCorner<3, 3>()));
      robots[0].sigma_team_m.push_back(0);
      robots[0].sigma_rad.push_back(0);
    }
    const std::vector<double> before = robots[0].sigma_position_m;
    widen_by_unknown_motions(robots, joint, *marginals);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const double second = joint.robots[0].stamps[k].seconds();
      if (second < kUnseen) {
        EXPECT_EQ(robots[0].sigma_position_m[k], before[k]);
        EXPECT_EQ(robots[0].sigma_rad[k], 0);
      } else {
        EXPECT_GT(robots[0].sigma_position_m[k], 0.99 * sigma_m) << second;
        EXPECT_NEAR(robots[0].sigma_rad[k], std::numbers::pi / std::sqrt(3), 1e-12) << "any heading";
        EXPECT_GT(robots[0].sigma_position_m[k], 0.99 * (second - kUnseen)) << "heading, " << second;
      }
    }
    EXPECT_GT(robots[0].sigma_team_m.front(), 0.4 * sigma_m) << "half of the way is behind it";
  }
}

}  // namespace
}  // namespace radioslam

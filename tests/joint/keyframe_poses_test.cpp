// Measurements between keyframes hang on the keyframe before them, by the motion since.
#include "radioslam/joint/keyframe_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"

namespace radioslam {
namespace {

constexpr double kEnd_s = 40;
const Eigen::Vector3d kAntenna(0.3, -0.2, 0), kReceiver(0.1, 0.4, 0);

/// On arcs and, in space, banked.
SE3 truth(std::size_t robot, double t_s, int dimension) {
  const double turn = robot == 0 ? 0.1 * t_s : 1 - 0.07 * t_s;
  SE3 pose = lift(SE2({12 * std::sin(turn) + 3 * static_cast<double>(robot), 9 * std::cos(turn)}, turn));
  if (dimension == 3)
    pose = pose * SE3(Eigen::Vector3d(0, 0, std::sin(0.3 * t_s)),
                      Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * std::sin(t_s), Eigen::Vector3d::UnitX())));
  return pose;
}

Stamp at(double t_s) { return Stamp::from_seconds(t_s); }

/// Two robots whose odometry is the truth, with exact measurements at times that are samples of the odometry
/// but no keyframes.
Mission exact_mission(int dimension) {
  Mission mission;
  mission.dimension = dimension;
  mission.robots.resize(2);
  for (std::size_t r = 0; r < 2; ++r) {
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k <= 10 * static_cast<int>(kEnd_s); ++k)
      rows.push_back({at(k / 10.0), truth(r, k / 10.0, dimension)});
    Robot& robot = mission.robots[r];
    robot.id = std::string(1, static_cast<char>('a' + r));
    robot.odometry = Trajectory<SE3>(std::move(rows));
    robot.initial_pose = SE3();
    robot.fix_lever_m = kReceiver;
  }
  for (int k = 3; k < 380; k += 17) {
    const double t_s = k / 10.0;
    const SE3 a = truth(0, t_s, dimension), b = truth(1, t_s, dimension);
    const LinkEnd i{RobotIndex(0), {}, {}, kAntenna}, j{RobotIndex(1), {}, {}, kReceiver};
    mission.ranges.push_back({at(t_s), i, j, (a * kAntenna - b * kReceiver).norm(), 0.3});
    const Eigen::Vector3d seen = a.inverse() * (b * kReceiver);
    AoaPath path;
    path.azimuth_rad = std::atan2(seen.y(), seen.x());
    path.sigma_rad = 0.1;
    if (k % 2 == 0) path.elevation_rad = std::atan2(seen.z(), seen.head<2>().norm());
    mission.aoa_measurements.push_back({at(t_s), RobotIndex(0), j, {path}});
    mission.matches.push_back({RobotIndex(1), RobotIndex(0), at(t_s), at(t_s + 1.3),
                               b.inverse() * truth(0, t_s + 1.3, dimension), isotropic_covariance(0.5, 0.1)});
    mission.robots[1].fixes.push_back({at(t_s), b * kReceiver, 1});
  }
  return mission;
}

constexpr KeyframeParams kSparse{4, 1, 0, 0};

template <class Pose>
class HangingMeasurements : public testing::Test {
 protected:
  Mission mission = exact_mission(Pose::kDim);
  JointGraph<Pose> joint = build_joint_graph<Pose>(mission, kSparse, {});
  const PoseGraph<Pose>& graph = joint.team.graph;
};
using BothDimensions = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(HangingMeasurements, BothDimensions);

TYPED_TEST(HangingMeasurements, AddNoPoses) {
  std::size_t keyframes = 0;
  for (std::size_t r = 0; r < 2; ++r)
    keyframes += choose_keyframes(this->mission, RobotIndex(r), kSparse).size();
  EXPECT_EQ(this->graph.poses.size(), keyframes);
  EXPECT_LT(keyframes, 40U);
}

TYPED_TEST(HangingMeasurements, OfExactOnesHaveNoResidual) {
  const auto& of_team = this->graph;
  const std::size_t count = this->mission.ranges.size();
  ASSERT_EQ(of_team.ranges.size(), count);
  ASSERT_EQ(this->joint.team.bearings.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_NEAR(residual(of_team, of_team.ranges[k])[0], 0, 1e-9) << k;
    EXPECT_LT(residual(of_team, path_factor(this->joint.team.bearings[k], 0)).norm(), 1e-9) << k;
  }
  auto closures = closures_of_matches(this->mission);
  hang_on_keyframes(this->joint, this->mission, closures);
  for (const Closure& closure : closures)
    EXPECT_LT(residual(of_team, closure_factor(this->joint, closure)).norm(), 1e-9);
}

TYPED_TEST(HangingMeasurements, OfFixesHaveNoResidual) {
  const auto fixes = place_by_fixes(this->joint, this->mission, {}, {});
  ASSERT_EQ(fixes[1].factors.size(), this->mission.robots[1].fixes.size());
  for (const auto& fix : fixes[1].factors) EXPECT_LT(residual(this->graph, fix).norm(), 1e-9);
}

TYPED_TEST(HangingMeasurements, KeepTheirTimes) {
  KeyframePoses<TypeParam> poses(this->joint, this->mission);
  for (std::size_t k = 0; k < this->graph.ranges.size(); ++k) {
    const Stamp stamp = this->mission.ranges[k].stamp;
    const auto before = poses.at(RobotIndex(0), stamp);
    ASSERT_TRUE(before);
    EXPECT_EQ(before->pose, this->graph.ranges[k].i.pose);
    EXPECT_EQ(before->keyframe.ns + this->graph.ranges[k].after_ns, stamp.ns);
    EXPECT_EQ(before->keyframe.ns + this->joint.team.bearings[k].after_ns, stamp.ns);
  }
  EXPECT_FALSE(poses.at(RobotIndex(0), at(-1)));
  EXPECT_FALSE(poses.at(RobotIndex(0), at(kEnd_s + 1)));
}

/// The variance of the odometry since both keyframes adds to the measurement's own.
TYPED_TEST(HangingMeasurements, AreAsUncertainAsTheWayToThem) {
  KeyframePoses<TypeParam> poses(this->joint, this->mission);
  auto closures = closures_of_matches(this->mission);
  hang_on_keyframes(this->joint, this->mission, closures);
  for (std::size_t k = 0; k < this->graph.ranges.size(); ++k) {
    const Stamp stamp = this->mission.ranges[k].stamp;
    const auto i = poses.at(RobotIndex(0), stamp), j = poses.at(RobotIndex(1), stamp);
    const double range_m2 = std::pow(this->graph.ranges[k].sigma_m, 2) - 0.3 * 0.3;
    EXPECT_NEAR(range_m2, i->motion.position_m2() + j->motion.position_m2(), 1e-12);
    const double angle_rad2 = std::pow(this->joint.team.bearings[k].paths[0].sigma_rad, 2) - 0.1 * 0.1;
    EXPECT_NEAR(angle_rad2, i->motion.rotation_rad2(), 1e-12);
    if (i->after_ns == 0) continue;
    const SE3::Jacobian covariance = inverse(closures[k].information);
    EXPECT_GT(covariance(0, 0) + covariance(1, 1), 2 * 0.5 * 0.5);
  }
}

}  // namespace
}  // namespace radioslam

#include "radioslam/sim/scenarios/corridors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

CorridorsParams without_noise() {
  CorridorsParams params;
  params.onboard.lidar.lidar_sigma_m = 0;
  return params;
}

/// The scan that begins when the robot is closest to a position.
std::size_t scan_nearest(const Simulation& simulation, std::size_t robot, const Eigen::Vector3d& place) {
  const LidarLog& lidar = simulation.mission.robots[robot].lidar;
  std::size_t best = 0;
  double nearest_m = 1e9;
  for (std::size_t k = 0; k < lidar.size(); ++k) {
    const auto pose = simulation.truth.robots[robot].poses.at(lidar.stamps[k]);
    const double distance_m = (pose->translation() - place).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    best = k;
  }
  return best;
}

/// Mean squares of the components of the normals seen by a scan, each by a ray towards its point.
Eigen::Vector3d normal_energy(const Simulation& simulation, const CorridorsParams& params, std::size_t k) {
  const RayWorld world(corridor_shapes(params, 1));
  const Robot& robot = simulation.mission.robots[0];
  const auto& truth = simulation.truth.robots[0].poses;
  const LidarScan scan = robot.lidar.read(k);
  Eigen::Vector3d energy = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Stamp own{robot.lidar.stamps[k].ns + Stamp::from_seconds(static_cast<double>(scan.times_s[i])).ns};
    const SE3 pose = *truth.at(own);
    const Eigen::Vector3d scanner = pose * Eigen::Vector3d(0, 0, params.onboard.lidar.lidar_height_m);
    const Eigen::Vector3d way = pose * scan.points[i].cast<double>() - scanner;
    const auto hit = world.cast({scanner, way.normalized()}, 2 * params.lidar_range_m);
    if (hit) energy += hit->normal.cwiseAbs2();
  }
  return energy / static_cast<double>(scan.points.size());
}

TEST(Corridors, AreFeaturelessWhereTheEndsAreOutOfSight) {
  const CorridorsParams params = without_noise();
  const Simulation simulation = simulate_corridors(params, 1);
  const double begin_m = params.room_m / 2 + params.lidar_range_m;
  const double end_m = params.room_m / 2 + params.corridor_m - params.lidar_range_m;
  EXPECT_GE(end_m - begin_m, 40);
  for (const double x : {begin_m + 0.5, 0.5 * (begin_m + end_m), end_m - 0.5}) {
    const std::size_t k = scan_nearest(simulation, 0, {x, 0, 0});
    const Eigen::Vector3d energy = normal_energy(simulation, params, k);
    EXPECT_LT(energy.x(), 1e-20) << "nothing faces along the corridor";
    EXPECT_GT(energy.y(), 0.3);
    EXPECT_GT(energy.z(), 0.05);
    EXPECT_NEAR(energy.sum(), 1, 1e-6) << "every point is a surface";
  }
  const Eigen::Vector3d room = normal_energy(simulation, params, scan_nearest(simulation, 0, {0, 0, 0}));
  EXPECT_GT(room.x(), 0.1) << "a room has walls in both directions";
}

TEST(Corridors, ThePointsOfAFeaturelessScanDoNotConstrainThePositionAlongIt) {
  // Independent of the world's own normals: every point is 1 m aside, on the floor or under the ceiling.
  const CorridorsParams params = without_noise();
  const Simulation simulation = simulate_corridors(params, 1);
  const std::size_t k = scan_nearest(simulation, 0, {44, 0, 0});
  const LidarScan scan = simulation.mission.robots[0].lidar.read(k);
  ASSERT_GT(scan.points.size(), 8000U);
  CorridorsParams fine = params;
  fine.onboard.truth_hz = 1000;
  const auto truth = simulate_corridors(fine, 1).truth.robots[0].poses;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Stamp own{simulation.mission.robots[0].lidar.stamps[k].ns +
                    Stamp::from_seconds(static_cast<double>(scan.times_s[i])).ns};
    const Eigen::Vector3d point = *truth.at(own) * scan.points[i].cast<double>();
    const double aside = std::abs(std::abs(point.y()) - 1), floor = std::abs(point.z()),
                 ceiling = std::abs(point.z() - params.ceiling_m);
    EXPECT_LT(std::min({aside, floor, ceiling}), 1e-4);
  }
}

TEST(Corridors, RobotsKeepClearOfEverything) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CorridorsParams params;
    params.robots = 4;
    params.onboard.lidar.lidar_beams = 1;
    const Simulation simulation = simulate_corridors(params, seed);
    const RayWorld world(corridor_shapes(params, seed));
    for (const auto& robot : simulation.truth.robots)
      for (const auto& [stamp, pose] : robot.poses)
        for (int k = 0; k < 16; ++k) {
          const double azimuth = std::numbers::pi * k / 8;
          const Eigen::Vector3d origin = pose * Eigen::Vector3d(0, 0, 0.3);
          const auto hit = world.cast({origin, {std::cos(azimuth), std::sin(azimuth), 0}}, 1000);
          ASSERT_TRUE(hit) << "nobody leaves the building";
          EXPECT_GT(hit->range_m, 0.3);
        }
  }
}

TEST(Corridors, BringScansAndInertialReadingsButNoOdometry) {
  const auto [mission, truth] = simulate_corridors({}, 2);
  EXPECT_EQ(mission.dimension, 3);
  EXPECT_EQ(mission.name, "corridors-2");
  ASSERT_EQ(mission.robots.size(), 2U);
  EXPECT_EQ(mission.ranges.size(), 40U);
  for (std::size_t r = 0; r < 2; ++r) {
    const Robot& robot = mission.robots[r];
    const auto& poses = truth.robots[r].poses;
    EXPECT_TRUE(robot.odometry.empty());
    EXPECT_FALSE(robot.initial_pose);
    EXPECT_GT(robot.lidar.size(), 800U);
    EXPECT_NEAR(static_cast<double>(robot.inertial.size()) / static_cast<double>(robot.lidar.size()), 20,
                0.1);
    EXPECT_NEAR(travelled_distance(poses).back(), 135, 3);
    for (const Stamp stamp : robot.lidar.stamps) ASSERT_TRUE(poses.covers(stamp));
    const SE3 rest = poses.front().pose.inverse() * *poses.at(Stamp::from_seconds(1.5));
    EXPECT_LT(rest.log().norm(), 1e-9) << "starts at rest";
    EXPECT_GT(poses.front().pose.rotation().angularDistance(lift(flatten(poses.front().pose)).rotation()),
              1e-4)
        << "and not quite level";
  }
  // The first robot ends where the second began.
  const auto &a = truth.robots[0].poses, &b = truth.robots[1].poses;
  EXPECT_LT((a.back().pose.translation() - b.front().pose.translation()).norm(), 10);
}

TEST(Corridors, WheelsMeasureThePathOnRequestAndWithoutScans) {
  CorridorsParams params;
  params.wheel_odometry = true;
  const Simulation wheels = simulate_corridors(params, 2);
  EXPECT_EQ(wheels.mission.robots[0].odometry.size(), wheels.truth.robots[0].poses.size());
  params.wheel_odometry = false;
  params.onboard.lidar.lidar_beams = 0;
  const Simulation dark = simulate_corridors(params, 2);
  EXPECT_TRUE(dark.mission.robots[0].lidar.empty());
  EXPECT_EQ(dark.mission.robots[0].odometry.size(), dark.truth.robots[0].poses.size());
}

TEST(Corridors, AnotherRobotLeavesTheOthersAsTheyAre) {
  CorridorsParams params;
  const Simulation two = simulate_corridors(params, 5);
  params.robots = 3;
  const Simulation three = simulate_corridors(params, 5), other = simulate_corridors(params, 6);
  for (std::size_t r = 0; r < 2; ++r) {
    const Robot &a = two.mission.robots[r], &b = three.mission.robots[r];
    EXPECT_EQ(a.lidar.read(300).points, b.lidar.read(300).points);
    EXPECT_EQ(a.inertial[5000].specific_force_mps2, b.inertial[5000].specific_force_mps2);
    EXPECT_NE(a.lidar.read(300).points, other.mission.robots[r].lidar.read(300).points);
  }
  EXPECT_EQ(two.mission.ranges.size(), 40U);
  EXPECT_EQ(three.mission.ranges.size(), 120U);
}

}  // namespace
}  // namespace radioslam

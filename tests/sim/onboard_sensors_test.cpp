// hall and city with scans and IMU samples: what scans see, and what stays unchanged.
#include "radioslam/sim/scenarios/onboard_sensors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radioslam/sim/scenarios/scenarios.hpp"
#include "radioslam/sim/worlds/town_houses.hpp"

namespace radioslam {
namespace {

CityParams short_city() {
  CityParams params;
  params.path_length_m = 250;
  params.min_contact_s = 0;
  return params;
}

/// Each point of some scans of a robot, in the common frame.
template <class Visit>
void for_each_point(const Simulation& simulation, std::size_t robot, std::size_t every, const Visit& visit) {
  const LidarLog& lidar = simulation.mission.robots[robot].lidar;
  const auto& truth = simulation.truth.robots[robot].poses;
  for (std::size_t k = 0; k < lidar.size(); k += every) {
    const LidarScan scan = lidar.read(k);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Stamp own{lidar.stamps[k].ns + Stamp::from_seconds(static_cast<double>(scan.times_s[i])).ns};
      visit(*truth.at(own) * scan.points[i].cast<double>());
    }
  }
}

void expect_same_but_sensors(const Simulation& a, const Simulation& b) {
  ASSERT_EQ(a.mission.robots.size(), b.mission.robots.size());
  for (std::size_t r = 0; r < a.mission.robots.size(); ++r) {
    const auto &x = a.mission.robots[r].odometry, &y = b.mission.robots[r].odometry;
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      ASSERT_EQ(x[k].pose.translation(), y[k].pose.translation());
      ASSERT_EQ(a.truth.robots[r].poses[k].pose.translation(), b.truth.robots[r].poses[k].pose.translation());
    }
  }
  ASSERT_EQ(a.mission.ranges.size(), b.mission.ranges.size());
  for (std::size_t k = 0; k < a.mission.ranges.size(); ++k)
    EXPECT_EQ(a.mission.ranges[k].range_m, b.mission.ranges[k].range_m);
}

TEST(OnboardSensors, ScansLeaveTheRestOfAMissionAsItIs) {
  HallParams hall;
  const Simulation blind = simulate_hall(hall, 3);
  EXPECT_TRUE(blind.mission.robots[0].lidar.empty());
  EXPECT_TRUE(blind.mission.robots[0].inertial.empty());
  hall.onboard.lidar.lidar_beams = 16;
  expect_same_but_sensors(blind, simulate_hall(hall, 3));
  CityParams city = short_city();
  const Simulation dark = simulate_city(city, 3);
  city.onboard.lidar.lidar_beams = 64;
  expect_same_but_sensors(dark, simulate_city(city, 3));
}

TEST(Hall, ScansShowWallsFloorAndPillarsMidwayBetweenTheAisles) {
  HallParams params;
  params.onboard.lidar.lidar_beams = 16;
  params.onboard.lidar.lidar_sigma_m = 0;
  const Simulation simulation = simulate_hall(params, 3);
  ASSERT_GT(simulation.mission.robots[0].lidar.size(), 800U);
  std::size_t on_pillars = 0, on_walls = 0;
  for_each_point(simulation, 0, 60, [&](const Eigen::Vector3d& p) {
    double to_pillar = 1e9;  // aisles at 2.5, 7.5, ..., 22.5 and at 2.5, 7, ..., 20.5
    for (const double x : {5.0, 10.0, 15.0, 20.0})
      for (const double y : {4.75, 9.25, 13.75, 18.25})
        to_pillar = std::min(to_pillar, std::abs(std::hypot(p.x() - x, p.y() - y) - 0.3));
    const double to_wall = std::min(
        {std::abs(p.x()), std::abs(p.x() - 25), std::abs(p.y()), std::abs(p.y() - 23), std::abs(p.z() - 4)});
    EXPECT_LT(std::min({to_pillar, to_wall, std::abs(p.z())}), 1e-4);
    if (to_pillar < 1e-4) ++on_pillars;
    if (to_wall < 1e-4) ++on_walls;
  });
  EXPECT_GT(on_pillars, 1000U);
  EXPECT_GT(on_walls, 1000U);
}

TEST(Hall, RobotsKeepClearOfThePillars) {
  const HallParams params;
  const auto pillars = hall_shapes(params).pillars;
  EXPECT_EQ(pillars.size(), 16U);
  for (const auto& robot : simulate_hall(params, 3).truth.robots)
    for (const auto& [stamp, pose] : robot.poses)
      for (const auto& pillar : pillars)
        EXPECT_GT((pose.translation().head<2>() - pillar.centre_m).norm(), pillar.radius_m + 0.5);
}

double distance_to_box_m(const UprightBox& box, const Eigen::Vector3d& p) {
  const Eigen::Vector2d offset = p.head<2>() - box.centre_m;
  const double along = std::abs(offset.dot(box.forward)) - box.half_size_m.x();
  const double across =
      std::abs(offset.x() * -box.forward.y() + offset.y() * box.forward.x()) - box.half_size_m.y();
  const double above = std::max(p.z() - box.top_m, box.bottom_m - p.z());
  const double inside = std::max({along, across, above});
  if (inside <= 0) return -inside;
  return std::sqrt(std::pow(std::max(along, 0.0), 2) + std::pow(std::max(across, 0.0), 2) +
                   std::pow(std::max(above, 0.0), 2));
}

TEST(City, ScansShowTheHousesAlongTheStreetsAndTheHills) {
  CityParams params = short_city();
  params.dimension = 3;
  params.onboard.lidar.lidar_beams = 16;
  params.onboard.lidar.lidar_sigma_m = 0;
  params.onboard.lidar.lidar_azimuth_steps = 300;
  const Simulation simulation = simulate_city(params, 4);
  const Rng rng = Rng(4).split("city");
  const Hills ground(params.sigma_height_m, rng.split("hills"));
  const auto houses = build_houses(params.streets, params.houses, ground, rng.split("houses"));
  std::size_t on_houses = 0, on_ground = 0;
  for_each_point(simulation, 0, 30, [&](const Eigen::Vector3d& p) {
    double to_house = 1e9;
    for (const auto& house : houses) to_house = std::min(to_house, distance_to_box_m(house, p));
    const double to_ground = std::abs(p.z() - ground.height_m(p.head<2>()));
    EXPECT_LT(std::min(to_house, to_ground), 1e-4);
    if (to_house < 1e-4) ++on_houses;
    if (to_ground < 1e-4) ++on_ground;
  });
  EXPECT_GT(on_houses, 5000U);
  EXPECT_GT(on_ground, 5000U);
}

TEST(City, HousesKeepClearOfTheStreets) {
  for (const double block_m : {20.0, 40.0, 100.0}) {
    CityParams params = short_city();
    params.streets.block_m = block_m;
    const auto houses = build_houses(params.streets, params.houses, Hills(), Rng(1));
    if (block_m > 90) {
      EXPECT_GT(houses.size(), 300U);
    }
    for (const auto& house : houses) {
      const Eigen::AlignedBox2d covers = footprint(house);
      for (int street = 0; street <= params.streets.blocks_x; ++street)
        for (const int axis : {0, 1}) {
          const double line_m = street * block_m;
          const double clear_m = std::max(covers.min()(axis) - line_m, line_m - covers.max()(axis));
          EXPECT_GT(clear_m, 0.5 * params.houses.street_width_m - 1e-9);
        }
    }
  }
}

TEST(OnboardSensors, WithAnInertialUnitEverythingFollowsTheSmoothMotion) {
  HallParams params;
  params.path_length_m = 20;
  params.onboard.inertial.imu_hz = 100;
  params.onboard.lidar.lidar_beams = 1;
  params.onboard.truth_hz = 200;
  const auto [mission, truth] = simulate_hall(params, 3);
  const auto& poses = truth.robots[0].poses;
  const Robot& robot = mission.robots[0];
  EXPECT_NEAR(poses.back().stamp.seconds(), 40 + 2 + 1, 1);
  EXPECT_EQ(poses[1].stamp.ns, 5000000);
  EXPECT_NEAR(robot.odometry.back().stamp.seconds(), poses.back().stamp.seconds(), 0.11);
  EXPECT_EQ(robot.odometry[1].stamp.ns, 100000000);
  // Its angular rate is that of the truth, its specific force that of the truth's second differences.
  const auto& inertial = robot.inertial;
  Eigen::Vector3d rates = Eigen::Vector3d::Zero(), forces = rates;
  int count = 0;
  for (std::size_t k = 1; 2 * k + 1 < poses.size() && k < inertial.size(); ++k, ++count) {
    const SE3 &before = poses[2 * k - 1].pose, &here = poses[2 * k].pose, &after = poses[2 * k + 1].pose;
    ASSERT_EQ(inertial[k].stamp, poses[2 * k].stamp);
    rates += inertial[k].angular_rate_radps - (before.inverse() * after).log().tail<3>() / 0.01;
    const Eigen::Vector3d bend =
        (after.translation() + before.translation() - 2 * here.translation()) / 25e-6;
    forces += inertial[k].specific_force_mps2 -
              here.rotation().conjugate() * (bend + Eigen::Vector3d(0, 0, kStandardGravity_mps2));
  }
  EXPECT_LT((rates / count).norm(), 0.01) << "a bias of 0.002 rad/s per axis";
  EXPECT_LT((forces / count).norm(), 0.25) << "a bias of 0.05 m/s^2 per axis";
}

TEST(OnboardSensors, APlaneStaysAPlane) {
  HallParams params;
  params.path_length_m = 10;
  params.onboard.inertial.imu_hz = 100;
  for (const auto& robot : simulate_hall(params, 3).truth.robots)
    for (const auto& [stamp, pose] : robot.poses)
      EXPECT_LT((pose.inverse() * lift(flatten(pose))).log().norm(), 1e-12);
}

}  // namespace
}  // namespace radioslam

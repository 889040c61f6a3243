// kitti with scans: one world for both robots, seen from the true poses, and nothing else changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/geometry/so3.hpp"
#include "radioslam/sim/scenarios/kitti.hpp"

namespace radioslam {
namespace {

/// Along a street, and after a loop back beside the first passage, 1 m higher; the odometry drifts.
RecordedDrive there_and_back() {
  std::vector<Eigen::Vector3d> places;
  for (int k = 0; k < 150; ++k) places.emplace_back(k, 6 * std::sin(k / 30.0), 0.03 * k);
  for (int k = 0; k < 75; ++k) {
    const double angle = (k / 75.0 - 0.5) * std::numbers::pi;
    places.emplace_back(150 + 24 * std::cos(angle), 6 * std::sin(5.0) + 24 + 24 * std::sin(angle), 4.5);
  }
  for (int k = 0; k < 24; ++k) places.emplace_back(149 - k, 6 * std::sin(5.0) + 48 - 1.9 * k, 4.5);
  for (int k = 122; k > 0; --k) places.emplace_back(k, 6 * std::sin(k / 30.0) + 2, 0.03 * k + 1);
  std::vector<StampedPose<SE3>> truth, odometry;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const Eigen::Vector3d way = places[k + 1] - places[k];
    const SE3 pose(places[k], so3_exp({0, 0, std::atan2(way.y(), way.x())}));
    const auto step = static_cast<std::int64_t>(k);
    truth.push_back({{step * 100'000'000}, pose});
    odometry.push_back({{step * 100'000'000}, pose * lift(SE2({1e-2 * static_cast<double>(k), 0}, 0))});
  }
  return {Trajectory<SE3>(std::move(truth)), Trajectory<SE3>(std::move(odometry))};
}

KittiParams with_scans() {
  KittiParams params;
  params.cut = 0.5;
  params.lidar_range_m = 30;
  params.lidar.lidar_beams = 16;
  return params;
}

/// All points of a scan in the common frame.
std::vector<Eigen::Vector3d> seen(const Simulation& simulation, std::size_t robot, std::size_t scan) {
  const LidarLog& lidar = simulation.mission.robots[robot].lidar;
  const LidarScan points = lidar.read(scan);
  std::vector<Eigen::Vector3d> seen;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Stamp own{lidar.stamps[scan].ns + Stamp::from_seconds(static_cast<double>(points.times_s[i])).ns};
    seen.push_back(*simulation.truth.robots[robot].poses.at(own) * points.points[i].cast<double>());
  }
  return seen;
}

/// The other robot's scan that begins nearest to a place.
std::size_t nearest_scan(const Simulation& simulation, std::size_t robot, const Eigen::Vector3d& place) {
  const auto& stamps = simulation.mission.robots[robot].lidar.stamps;
  const auto distance = [&](Stamp stamp) {
    return (simulation.truth.robots[robot].poses.at(stamp)->translation() - place).norm();
  };
  return static_cast<std::size_t>(
      std::min_element(stamps.begin(), stamps.end(),
                       [&](Stamp a, Stamp b) { return distance(a) < distance(b); }) -
      stamps.begin());
}

TEST(KittiScans, RobotsSeeTheSameStreetAtDifferentTimes) {
  const Simulation simulation = simulate_kitti(with_scans(), there_and_back(), 1);
  for (const std::size_t scan : {20U, 50U, 80U}) {
    const Stamp stamp = simulation.mission.robots[0].lidar.stamps[scan];
    const Eigen::Vector3d place = simulation.truth.robots[0].poses.at(stamp)->translation();
    const std::size_t later = nearest_scan(simulation, 1, place);
    const auto first = seen(simulation, 0, scan), second = seen(simulation, 1, later);
    ASSERT_GT(first.size(), 3000U);
    // Walls and trees are upright: seen from above, the later passage has points where the first has.
    std::size_t walls = 0, again = 0;
    for (const auto& point : first) {
      if ((point - place).head<2>().norm() > 15 || point.z() < place.z() - 1) continue;
      ++walls;
      again += std::any_of(second.begin(), second.end(), [&](const Eigen::Vector3d& other) {
        return other.z() > place.z() - 1 && (other - point).head<2>().norm() < 0.2;
      });
    }
    EXPECT_GT(walls, 1000U);
    EXPECT_GT(static_cast<double>(again), 0.9 * static_cast<double>(walls));
  }
}

TEST(KittiScans, ShowTheGroundUnderTheBody) {
  for (const int dimension : {2, 3}) {
    KittiParams params = with_scans();
    params.dimension = dimension;
    const Simulation simulation = simulate_kitti(params, there_and_back(), 1);
    // In front of the scanner, 15 degrees down, in body coordinates.
    std::vector<double> heights_m;
    for (const auto& point : simulation.mission.robots[0].lidar.read(30).points)
      if (point.head<2>().norm() < 9 && std::abs(point.y()) < 3 && point.z() < 0)
        heights_m.push_back(static_cast<double>(point.z()));
    ASSERT_GT(heights_m.size(), 50U);
    for (const double height_m : heights_m)
      EXPECT_NEAR(height_m, -params.body_height_m, dimension == 2 ? 0.05 : 0.6);
  }
}

TEST(KittiScans, AreAsFarAsTheMissionSaysAndBelongToTheirRobot) {
  const KittiParams params = with_scans();
  const RecordedDrive drive = there_and_back();
  const Simulation simulation = simulate_kitti(params, drive, 1);
  for (const auto& robot : simulation.mission.robots) {
    EXPECT_EQ(robot.lidar_range_m, 30);
    EXPECT_NEAR(static_cast<double>(robot.lidar.size()), static_cast<double>(robot.odometry.size()), 1.5);
    double furthest_m = 0;
    for (std::size_t scan = 0; scan < robot.lidar.size(); scan += 40)
      for (const auto& point : robot.lidar.read(scan).points)
        furthest_m = std::max(furthest_m, static_cast<double>(point.norm()));
    EXPECT_LT(furthest_m, 30 + 1e-5);
    EXPECT_GT(furthest_m, 25);
  }
  const auto points = simulation.mission.robots[1].lidar.read(7).points;
  const auto again = simulate_kitti(params, drive, 1).mission.robots[1].lidar.read(7).points;
  EXPECT_EQ(points, again);
  EXPECT_NE(points, simulate_kitti(params, drive, 2).mission.robots[1].lidar.read(7).points);
}

TEST(KittiScans, LeaveTheRestOfTheMissionAsItIs) {
  KittiParams params = with_scans();
  const RecordedDrive drive = there_and_back();
  const Simulation scanned = simulate_kitti(params, drive, 1);
  params.lidar.lidar_beams = 0;
  const Simulation blind = simulate_kitti(params, drive, 1);
  EXPECT_EQ(KittiParams().lidar.lidar_beams, 0);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_TRUE(blind.mission.robots[r].lidar.empty());
    const auto &odometry = blind.mission.robots[r].odometry, &same = scanned.mission.robots[r].odometry;
    ASSERT_EQ(odometry.size(), same.size());
    for (std::size_t k = 0; k < odometry.size(); ++k) {
      EXPECT_EQ(odometry[k].stamp, same[k].stamp);
      EXPECT_EQ(odometry[k].pose.translation(), same[k].pose.translation());
      EXPECT_EQ(blind.truth.robots[r].poses[k].pose.translation(),
                scanned.truth.robots[r].poses[k].pose.translation());
    }
  }
  ASSERT_EQ(blind.mission.ranges.size(), scanned.mission.ranges.size());
  for (std::size_t k = 0; k < blind.mission.ranges.size(); ++k)
    EXPECT_EQ(blind.mission.ranges[k].range_m, scanned.mission.ranges[k].range_m);
}

}  // namespace
}  // namespace radioslam

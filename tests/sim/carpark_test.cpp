#include "radioslam/sim/scenarios/carpark.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>
#include <string>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// A short mission, quick to simulate.
CarparkParams short_drive() {
  CarparkParams params;
  params.drive.path_length_m = 100;
  params.odometry.end_error_min_m = 0;
  return params;
}

/// Everything that a robot recorded and its truth, number for number.
std::string bytes(const Robot& robot, const RobotTruth& truth) {
  std::string out = robot.id;
  const auto add = [&out](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));  // NOLINT: plain numbers only
  };
  const auto add_poses = [&](const Trajectory<SE3>& trajectory) {
    for (const auto& [stamp, pose] : trajectory) {
      add(stamp.ns);
      for (const double x : pose.translation()) add(x);
      for (const double x : pose.rotation().coeffs()) add(x);
    }
  };
  add_poses(robot.odometry);
  add_poses(truth.poses);
  for (const auto& scan : robot.wifi) {
    add(scan.stamp.ns);
    for (const auto& reading : scan.readings) {
      add(reading.access_point.value);
      add(reading.frequency_mhz);
      add(reading.rssi_dbm);
    }
  }
  return out;
}

std::string bytes(const Simulation& simulation) {
  std::string out = simulation.mission.name;
  for (const auto& bssid : simulation.mission.access_points) out += bssid;
  for (std::size_t r = 0; r < simulation.mission.robots.size(); ++r)
    out += bytes(simulation.mission.robots[r], simulation.truth.robots[r]);
  return out;
}

TEST(Carpark, StartsWhereTheMissionStates) {
  const auto [mission, truth] = simulate_carpark(short_drive(), 1);
  ASSERT_EQ(mission.robots.size(), 2U);
  ASSERT_EQ(truth.robots.size(), 2U);
  for (std::size_t r = 0; r < 2; ++r) {
    const Robot& robot = mission.robots[r];
    EXPECT_EQ(truth.robots[r].id, robot.id);
    ASSERT_TRUE(robot.initial_pose);
    const auto& [stamp, start] = truth.robots[r].poses.front();
    EXPECT_EQ(stamp, robot.odometry.front().stamp);
    EXPECT_LT((robot.initial_pose->inverse() * start).log().norm(), 1e-12);
    EXPECT_LT(robot.odometry.front().pose.log().norm(), 1e-12);
  }
  EXPECT_GT(
      (mission.robots[0].initial_pose->translation() - mission.robots[1].initial_pose->translation()).norm(),
      10);
}

TEST(Carpark, KeepsTheStartToItselfWhenAsked) {
  CarparkParams params = short_drive();
  const auto known = simulate_carpark(params, 1);
  params.known_start = false;
  const auto unknown = simulate_carpark(params, 1);
  for (const auto& robot : unknown.mission.robots) EXPECT_FALSE(robot.initial_pose);
  EXPECT_EQ(bytes(known), bytes(unknown));  // nothing else changes
}

TEST(Carpark, RecordsAtTheRatesAskedFor) {
  const auto [mission, truth] = simulate_carpark(short_drive(), 2);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(mission.robots[r].odometry.size(), 250U * 5 + 1);  // 100 m at 0.4 m/s
    EXPECT_EQ(truth.robots[r].poses.size(), 250U * 2 + 1);
    EXPECT_NEAR(static_cast<double>(mission.robots[r].wifi.size()), 250 * 2.5 * 0.97, 30);
  }
}

TEST(Carpark, StaysOnItsLanes) {
  CarparkParams params;
  params.transmitters.access_points = 1;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const LaneGrid lanes = make_carpark_world(params, seed).lanes;
    const auto [mission, truth] = simulate_carpark(params, seed);
    for (const auto& robot : truth.robots) {
      double length_m = 0;
      for (std::size_t i = 0; i < robot.poses.size(); ++i) {
        const auto p = robot.poses[i].pose.translation();
        EXPECT_LT(lanes.distance_to_lane_m(p.head<2>()), 2.5);  // an aisle is 6 m wide
        EXPECT_TRUE(p.x() > 0 && p.x() < 85 && p.y() > 0 && p.y() < 60 && p.z() == 0);
        if (i > 0) length_m += (p - robot.poses[i - 1].pose.translation()).norm();
      }
      EXPECT_NEAR(length_m, 600, 15);
    }
  }
}

TEST(Carpark, DeadReckoningEndsTenToTwentyMetresOff) {
  CarparkParams params;
  params.transmitters.access_points = 1;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto [mission, truth] = simulate_carpark(params, seed);
    for (std::size_t r = 0; r < mission.robots.size(); ++r) {
      const Robot& robot = mission.robots[r];
      const SE3 end = *robot.initial_pose * robot.odometry.back().pose;
      const double error_m = (end.translation() - truth.robots[r].poses.back().pose.translation()).norm();
      EXPECT_GE(error_m, 10) << "seed " << seed;
      EXPECT_LE(error_m, 20) << "seed " << seed;
      sum += error_m;
    }
  }
  EXPECT_NEAR(sum / 40, 15, 2.5);
}

TEST(Carpark, DetectsTenToFortyAccessPointsInAScan) {
  const auto [mission, truth] = simulate_carpark(short_drive(), 4);
  EXPECT_EQ(mission.access_points.size(), 70U);
  double readings = 0, scans = 0;
  for (const auto& robot : mission.robots)
    for (const auto& scan : robot.wifi) {
      ++scans;
      readings += static_cast<double>(scan.readings.size());
      for (std::size_t i = 1; i < scan.readings.size(); ++i)
        EXPECT_LT(scan.readings[i - 1].access_point, scan.readings[i].access_point);
    }
  EXPECT_GT(readings / scans, 10);
  EXPECT_LT(readings / scans, 40);
}

TEST(Carpark, SignalsFallWithDistanceAtTheExponentSet) {
  CarparkParams params = short_drive();
  params.transmitters.sigma_exponent = params.transmitters.sigma_power_at_1m_db = 0;
  params.transmitters.outside_loss_db = params.transmitters.band_5ghz_ratio = 0;
  params.phones.threshold_dbm = params.phones.floor_dbm = -300;  // everything is detected: no selection
  const auto world = make_carpark_world(params, 5);
  const auto [mission, truth] = simulate_carpark(params, 5);
  // Least squares of RSS = P0 - n 10 log10(d) over all readings.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    for (const auto& scan : mission.robots[r].wifi) {
      const auto pose = truth.robots[r].poses.at(scan.stamp);
      ASSERT_TRUE(pose);
      const Eigen::Vector3d phone = pose->translation() + Eigen::Vector3d(0, 0, 0.8);
      for (const auto& reading : scan.readings) {
        const auto& position = world.transmitters[reading.access_point.index()].position();
        const Eigen::Vector2d row(1, -10 * std::log10((phone - position).norm()));
        normal += row * row.transpose();
        right += row * static_cast<double>(reading.rssi_dbm);
      }
    }
  const Eigen::Vector2d fit = normal.ldlt().solve(right);
  EXPECT_NEAR(fit[1], params.transmitters.mean_exponent, 0.15);
  EXPECT_NEAR(fit[0], params.transmitters.mean_power_at_1m_dbm, 2.5);
}

TEST(Carpark, IsTheSameForTheSameSeedAndAnyThreads) {
  set_thread_count(1);
  const auto one = bytes(simulate_carpark(short_drive(), 6));
  set_thread_count(2);
  const auto two = bytes(simulate_carpark(short_drive(), 6));
  set_thread_count(0);
  EXPECT_EQ(one, two);
  EXPECT_NE(one, bytes(simulate_carpark(short_drive(), 7)));
}

TEST(Carpark, AThirdRobotLeavesTheOthersAlone) {
  CarparkParams params = short_drive();
  const auto two = simulate_carpark(params, 8);
  params.robots = 3;
  const auto three = simulate_carpark(params, 8);
  ASSERT_EQ(three.mission.robots.size(), 3U);
  EXPECT_EQ(two.mission.access_points, three.mission.access_points);
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_EQ(bytes(two.mission.robots[r], two.truth.robots[r]),
              bytes(three.mission.robots[r], three.truth.robots[r]));
}

TEST(Carpark, ManyRobotsHaveTheirOwnNamesAndStarts) {
  CarparkParams params = short_drive();
  params.drive.path_length_m = 5;
  params.transmitters.access_points = 1;
  params.robots = 30;  // more than there are crossings
  const auto [mission, truth] = simulate_carpark(params, 9);
  std::set<std::string> ids;
  for (const auto& robot : mission.robots) ids.insert(robot.id);
  EXPECT_EQ(ids.size(), 30U);
}

}  // namespace
}  // namespace radioslam

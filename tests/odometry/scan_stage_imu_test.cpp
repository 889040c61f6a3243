#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "lidar/scan_drive.hpp"
#include "radioslam/odometry/scan_stage.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kLap_s = 16, kReadings_hz = 100, kGravity_mps2 = 9.81;
constexpr int kScans = 160;

/// One lap of the furnished room at varying speed.
SE3 lap_pose(double t) {
  const double lap = 2 * std::numbers::pi * t / kLap_s, angle = lap + 0.3 * std::sin(2 * lap);
  return pose_at(2.4 * std::cos(angle), 0.9 * std::sin(angle), 1.2,
                 std::atan2(0.9 * std::cos(angle), -2.4 * std::sin(angle)));
}

/// The same on soft suspension: small motions in height, roll and pitch.
SE3 rocking_lap_pose(double t) {
  const double sway = 2 * std::numbers::pi * t / 3.1;
  SE3::Tangent rock = SE3::Tangent::Zero();
  rock[2] = 0.01 * std::sin(0.7 * sway);
  rock[3] = 0.02 * std::sin(sway);
  rock[4] = 0.03 * std::cos(1.3 * sway);
  return lap_pose(t) * SE3::exp(rock);
}

using PathFunction = SE3 (*)(double t);

/// IMU sample by finite differences over a millisecond.
ImuSample lap_reading(PathFunction path, double t) {
  constexpr double h = 1e-3;
  const SE3 before = path(t - h), here = path(t), after = path(t + h);
  const Eigen::Vector3d acceleration =
      (before.translation() - 2 * here.translation() + after.translation()) / (h * h);
  return {Stamp::from_seconds(t),
          here.rotation().conjugate() * (acceleration + Eigen::Vector3d(0, 0, kGravity_mps2)),
          (before.inverse() * after).log().tail<3>() / (2 * h)};
}

ScanDrive lap_drive(PathFunction path) {
  std::vector<SE3> poses;
  for (int k = 0; k < kScans; ++k) poses.push_back(path(0.1 * k));
  Scanner scanner = planar_scanner(360);
  scanner.sweep_s = 0.09;
  return drive_along(furnished_room(), scanner, poses, 1);
}

struct LapRun {
  Trajectory<SE3> odometry;
  std::vector<std::string> notes;
  double worst_m = 0;
  bool by_imu = false;
};

using Spoil = std::function<void(std::size_t, ImuSample&)>;

LapRun run_lap(const Spoil& spoil, bool enabled = true, PathFunction path_of_body = lap_pose) {
  static const ScanDrive even = lap_drive(lap_pose), rocking = lap_drive(rocking_lap_pose);
  const ScanDrive& drive = path_of_body == rocking_lap_pose ? rocking : even;
  Robot robot;
  robot.id = "a";
  robot.lidar = log_of(drive);
  for (int k = 0; k <= 16.1 * kReadings_hz; ++k) {
    robot.inertial.push_back(lap_reading(path_of_body, k / kReadings_hz));
    spoil(static_cast<std::size_t>(k), robot.inertial.back());
  }
  Mission mission;
  mission.dimension = 2;
  mission.robots = {robot};
  ScanParams params;
  params.inertial.stage.enabled = enabled;
  LapRun run;
  const MeasuredScans measured = measure_scans(mission, params, {}, {});
  run.notes = measured.notes;
  run.by_imu = measured.robots[0]->by_imu.has_value();
  run.odometry = with_odometry(mission, measured, {}).robots[0].odometry;
  for (std::size_t k = 0; k < run.odometry.size(); ++k) {
    const SE3 path = run.odometry.front().pose.inverse() * run.odometry[k].pose;
    const SE3 off(drive.way_to(k).translation() - path.translation(), Eigen::Quaterniond::Identity());
    run.worst_m =
        std::max(run.worst_m, off.translation().head<2>().norm());  // a planar scanner observes no height
  }
  return run;
}

void keep(std::size_t, ImuSample&) {}

void expect_left_out(const LapRun& run, const std::string& why) {
  ASSERT_EQ(run.notes.size(), 1U);
  EXPECT_NE(run.notes[0].find(why), std::string::npos) << run.notes[0];
  EXPECT_NE(run.notes[0].find("ignored"), std::string::npos) << run.notes[0];
  EXPECT_FALSE(run.by_imu);
  const LapRun without = run_lap(keep, false);
  ASSERT_EQ(run.odometry.size(), without.odometry.size());
  for (std::size_t k = 0; k < run.odometry.size(); ++k)
    EXPECT_EQ(run.odometry[k].pose.translation(), without.odometry[k].pose.translation());
}

void expect_used_well(PathFunction path_of_body) {
  const LapRun alone = run_lap(keep, false, path_of_body), run = run_lap(keep, true, path_of_body);
  EXPECT_TRUE(run.notes.empty()) << run.notes.front();
  EXPECT_EQ(run.odometry.size(), static_cast<std::size_t>(kScans));
  EXPECT_TRUE(run.by_imu);
  EXPECT_FALSE(alone.by_imu);
  EXPECT_LT(run.worst_m, 0.05);
  EXPECT_LT(run.worst_m, 1.2 * alone.worst_m);
}

TEST(InertialReadings, ThatAreGoodAreUsedWithoutANote) { expect_used_well(lap_pose); }

/// A planar scan does not observe height, roll and pitch, and must not constrain them to zero either.
TEST(InertialReadings, OfARockingRobotAreUsedWithPlanarScans) { expect_used_well(rocking_lap_pose); }

TEST(InertialReadings, InGAreLeftOut) {
  expect_left_out(run_lap([](std::size_t, ImuSample& s) { s.specific_force_mps2 /= kGravity_mps2; }),
                  "are its values in g?");
}

TEST(InertialReadings, InDegreesAreLeftOut) {
  expect_left_out(run_lap([](std::size_t, ImuSample& s) { s.angular_rate_radps /= kDegree; }),
                  "are its values in rad/s");
}

TEST(InertialReadings, UpsideDownAreLeftOut) {
  expect_left_out(run_lap([](std::size_t, ImuSample& s) {
                    s.specific_force_mps2.tail<2>() *= -1;
                    s.angular_rate_radps.tail<2>() *= -1;
                  }),
                  "its gyroscope measures -");
}

TEST(InertialReadings, OfAnotherMountingAreLeftOut) {
  expect_left_out(run_lap([](std::size_t, ImuSample& s) {
                    for (Eigen::Vector3d* v : {&s.specific_force_mps2, &s.angular_rate_radps})
                      *v = Eigen::Vector3d(v->x(), v->z(), -v->y());
                  }),
                  "its gyroscope");
}

TEST(InertialReadings, OfAnotherClockAreLeftOut) {
  expect_left_out(run_lap([](std::size_t, ImuSample& s) { s.stamp.ns += 400'000'000; }), "too late");
}

TEST(InertialReadings, WithOneOutlierAreUsedWithoutIt) {
  for (const double outlier : {1e8, 500.0}) {
    const LapRun run = run_lap([&](std::size_t k, ImuSample& s) {
      if (k == 333) s.specific_force_mps2.x() = outlier;
    });
    ASSERT_EQ(run.notes.size(), 1U);
    EXPECT_NE(run.notes[0].find("robot a: 1 IMU samples"), std::string::npos) << run.notes[0];
    EXPECT_LT(run.worst_m, 0.05);
  }
}

}  // namespace
}  // namespace radioslam

// Faults of single recordings, each beside the same mission without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "doctor/sound_mission.hpp"
#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/doctor/odometry_noise.hpp"

namespace radioslam {
namespace {

std::string all_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += finding.kind + " " + finding.robot + ": " + text_of(finding) + "\n";
  return text;
}

/// The text of the finding of this kind about the file, or nothing.
std::string found(const Mission& mission, const std::string& kind, const std::string& file) {
  for (const Finding& finding : check_mission(mission))
    if (finding.kind == kind && finding.file == file) return text_of(finding);
  return {};
}

void expect_silence(const Mission& mission) {
  const auto findings = check_mission(mission);
  EXPECT_TRUE(findings.empty()) << all_of(findings);
}

constexpr double kEnd_s = 240;

/// The first robot's path, four times as long and as fast: 1 to 6 m/s.
SE2 driven_pose(double t_s) {
  const SE2 pose = true_pose(0, t_s);
  return {4 * pose.translation(), pose.angle()};
}

WifiScan scan_at(double stamp_s, double true_s, Rng& random) {
  WifiScan scan{Stamp::from_seconds(stamp_s), {}};
  for (std::size_t k = 0; k < 40; ++k) {
    const double angle = 2.4 * static_cast<double>(k), radius = 32 * std::sqrt(static_cast<double>(k));
    const double d_m =
        (driven_pose(true_s).translation() - radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)))
            .norm();
    const double rssi_dbm = std::round(-25 - 28 * std::log10(1 + d_m) + 3 * random.normal());
    if (rssi_dbm > -88) scan.readings.push_back({AccessPointIndex(k), 2412, static_cast<float>(rssi_dbm)});
  }
  return scan;
}

/// One fast robot with scans every two seconds, whose times are late.
Mission drive(double late_s, std::uint64_t seed = 1) {
  Rng random(seed);
  Mission mission;
  for (int k = 0; k < 40; ++k) mission.access_points.push_back("02:00:00:00:00:" + std::to_string(10 + k));
  Robot& robot = mission.robots.emplace_back();
  robot.id = "a";
  std::vector<StampedPose<SE3>> poses;
  for (double t_s = 0; t_s <= kEnd_s; t_s += 0.2)
    poses.push_back({Stamp::from_seconds(t_s), lift(driven_pose(0).inverse() * driven_pose(t_s))});
  robot.odometry = Trajectory<SE3>(std::move(poses));
  for (double t_s = 4; t_s < kEnd_s - 2; t_s += 2) robot.wifi.push_back(scan_at(t_s, t_s - late_s, random));
  return mission;
}

TEST(FingerprintClock, FindsScansThatAreThreeSecondsLateOrEarly) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    expect_silence(drive(0, seed));
    EXPECT_NE(found(drive(3, seed), "clock", "robots/a/wifi.csv").find(" s late"), std::string::npos);
    EXPECT_NE(found(drive(-3, seed), "clock", "robots/a/wifi.csv").find(" s early"), std::string::npos);
  }
}

/// On a straight road at constant speed, a lag only moves the access points.
TEST(FingerprintClock, CannotKnowOnAStraightRoad) {
  Mission mission = drive(3);
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : mission.robots[0].odometry)
    poses.push_back({pose.stamp, SE3({5 * pose.stamp.seconds(), 0, 0}, Eigen::Quaterniond::Identity())});
  mission.robots[0].odometry = Trajectory<SE3>(std::move(poses));
  EXPECT_EQ(found(mission, "clock", "robots/a/wifi.csv"), "");
}

TEST(StaleScans, FindsScansThatRepeatOlderOnes) {
  Mission mission = SoundMission::make(7);
  auto& scans = mission.robots[1].wifi;
  for (std::size_t k = 5; k < scans.size(); k += 7) scans[k].readings = scans[k - 1 - k % 3].readings;
  EXPECT_NE(found(mission, "stale", "robots/b/wifi.csv"), "");
}

TEST(StaleScans, FindsReadingsThatWereKept) {
  Mission mission = SoundMission::make(7);
  Rng random(1);
  auto& scans = mission.robots[1].wifi;
  for (std::size_t k = 1; k < scans.size(); ++k)
    for (WifiReading& reading : scans[k].readings)
      for (const WifiReading& older : scans[k - 1].readings)
        if (older.access_point == reading.access_point && random.uniform() < 0.5) reading = older;
  EXPECT_NE(found(mission, "stale", "robots/b/wifi.csv"), "");
}

/// A robot at rest hears the same again.
TEST(StaleScans, DoNotShowAtRest) {
  Mission mission = drive(0);
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : mission.robots[0].odometry) poses.push_back({pose.stamp, SE3()});
  mission.robots[0].odometry = Trajectory<SE3>(std::move(poses));
  for (WifiScan& scan : mission.robots[0].wifi) scan.readings = mission.robots[0].wifi[0].readings;
  EXPECT_EQ(found(mission, "stale", "robots/a/wifi.csv"), "");
}

Mission with_odometry_between(double begin_s, double end_s) {
  Mission mission = drive(0);
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : mission.robots[0].odometry)
    if (begin_s <= pose.stamp.seconds() && pose.stamp.seconds() <= end_s) poses.push_back(pose);
  const SE3 T_begin_start = poses.front().pose.inverse();
  for (auto& pose : poses) pose.pose = T_begin_start * pose.pose;
  mission.robots[0].odometry = Trajectory<SE3>(std::move(poses));
  return mission;
}

TEST(OdometryCoverage, NamesTheTimesThatAreCovered) {
  EXPECT_EQ(found(with_odometry_between(0, 200), "gap", "robots/a/odometry.tum"), "");
  const std::string early = found(with_odometry_between(0, 48), "gap", "robots/a/odometry.tum");
  EXPECT_NE(early.find("poses from 0.0 to 48.0 s only"), std::string::npos) << early;
  const std::string late = found(with_odometry_between(120, kEnd_s), "gap", "robots/a/odometry.tum");
  EXPECT_NE(late.find("rows from 4.0 to 236.0 s"), std::string::npos) << late;
}

/// Adds a random walk to the steps.
Mission with_noise(double sigma_per_sqrt_m, double stated) {
  Mission mission = drive(0);
  Rng random(5);
  Robot& robot = mission.robots[0];
  robot.odometry_noise.sigma_xy_per_sqrt_m = stated;
  std::vector<StampedPose<SE3>> poses{robot.odometry[0]};
  for (std::size_t k = 1; k < robot.odometry.size(); ++k) {
    const SE3 step = robot.odometry[k - 1].pose.inverse() * robot.odometry[k].pose;
    const double sigma_m = sigma_per_sqrt_m * std::sqrt(step.translation().norm());
    const Eigen::Vector3d noise(sigma_m * random.normal(), sigma_m * random.normal(), 0);
    poses.push_back(
        {robot.odometry[k].stamp, poses.back().pose * SE3(step.translation() + noise, step.rotation())});
  }
  robot.odometry = Trajectory<SE3>(std::move(poses));
  return mission;
}

TEST(OdometryNoise, IsMeasuredAsItWasMade) {
  const auto measured = measured_sigma_xy_per_sqrt_m(with_noise(0.02, 0.02).robots[0].odometry);
  ASSERT_TRUE(measured);
  EXPECT_NEAR(*measured, 0.02, 0.002);
}

TEST(OdometryNoise, IsNotThatOfErrorsAboutEachPose) {
  Mission mission = drive(0);
  Rng random(6);
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : mission.robots[0].odometry)
    poses.push_back({pose.stamp, SE3(pose.pose.translation() +
                                         0.03 * Eigen::Vector3d(random.normal(), random.normal(), 0),
                                     pose.pose.rotation())});
  EXPECT_FALSE(measured_sigma_xy_per_sqrt_m(Trajectory<SE3>(std::move(poses))));
}

TEST(OdometryNoise, ContradictsSigmasThatAreTwentyTimesTooSmallOnly) {
  EXPECT_NE(found(with_noise(0.02, 0.001), "noise", "mission.yaml"), "");
  for (const double stated : {0.01, 0.02, 0.04})
    EXPECT_EQ(found(with_noise(0.02, stated), "noise", "mission.yaml"), "");
}

/// Centripetal acceleration in the given axis.
Mission with_curves_along(Eigen::Index axis, double sign) {
  Mission mission = drive(0);
  for (double t_s = 0; t_s < kEnd_s; t_s += 0.1) {
    ImuSample sample;
    sample.stamp = Stamp::from_seconds(t_s);
    const double rate_radps =
        wrap_angle(driven_pose(t_s + 0.1).angle() - driven_pose(t_s - 0.1).angle()) / 0.2;
    const double speed_mps =
        (driven_pose(t_s + 0.1).translation() - driven_pose(t_s - 0.1).translation()).norm() / 0.2;
    sample.specific_force_mps2 = {0, 0, 9.81};
    sample.specific_force_mps2(axis) = sign * speed_mps * rate_radps;
    sample.angular_rate_radps = {0, 0, rate_radps};
    mission.robots[0].inertial.push_back(sample);
  }
  return mission;
}

TEST(InertialAxes, CurvesAreMeasuredToTheLeft) {
  expect_silence(with_curves_along(1, 1));
  EXPECT_NE(found(with_curves_along(0, 1), "column-order", "robots/a/imu.csv"), "");
  EXPECT_NE(found(with_curves_along(1, -1), "handedness", "robots/a/imu.csv"), "");
}

TEST(InertialUnits, DegreesPerSecondShowWithoutOdometry) {
  Mission mission = with_curves_along(1, 1);
  mission.robots[0].odometry = {};
  EXPECT_EQ(found(mission, "unit", "robots/a/imu.csv"), "");
  for (ImuSample& sample : mission.robots[0].inertial) sample.angular_rate_radps *= 57.3;
  EXPECT_NE(found(mission, "unit", "robots/a/imu.csv"), "");
}

}  // namespace
}  // namespace radioslam

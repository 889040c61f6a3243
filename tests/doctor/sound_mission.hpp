// A mission without faults: three robots on winding paths with exact odometry, IMU, WiFi scans, and noisy
// ranges and angles with a spurious path.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Place in the common frame of robot `r` at `t_s`: three circles on each other, at about 1 m/s.
inline Eigen::Vector2d true_place(std::size_t r, double t_s) {
  const double sense = r == 1 ? -1 : 1;
  Eigen::Vector2d place(0, 0);
  for (const auto& [radius_m, rate] : {std::pair{25.0, 0.013}, {12.0, 0.05 * sense}, {3.0, -0.2 * sense}}) {
    const double angle = rate * t_s + (1.7 + 20 * rate) * static_cast<double>(r);
    place += radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return place;
}

/// With body x forward.
inline SE2 true_pose(std::size_t r, double t_s) {
  const Eigen::Vector2d velocity = true_place(r, t_s + 1e-3) - true_place(r, t_s - 1e-3);
  return {true_place(r, t_s), std::atan2(velocity.y(), velocity.x())};
}

inline double distance_to(const Eigen::Vector2d& place, std::size_t r, double t_s) {
  return (true_pose(r, t_s).translation() - place).norm();
}

class SoundMission {
 public:
  static constexpr double kDuration_s = 240;
  static constexpr std::size_t kRobots = 3;

  static Mission make(std::uint64_t seed = 1) {
    SoundMission maker(seed);
    maker.mission_.name = "sound";
    for (int k = 0; k < 40; ++k)
      maker.mission_.access_points.push_back("02:00:00:00:00:" + std::to_string(10 + k));
    for (std::size_t r = 0; r < kRobots; ++r) maker.add_robot(r);
    for (double t_s = 1; t_s < kDuration_s; t_s += 1.5) maker.add_links(t_s);
    return std::move(maker.mission_);
  }

 private:
  explicit SoundMission(std::uint64_t seed) : random_(seed) {}

  void add_robot(std::size_t r) {
    Robot robot;
    robot.id = std::string(1, static_cast<char>('a' + r));
    const SE2 start = true_pose(r, 0);
    std::vector<StampedPose<SE3>> poses;
    for (double t_s = 0; t_s <= kDuration_s; t_s += 0.2) {
      const SE2 pose = start.inverse() * true_pose(r, t_s);
      poses.push_back({Stamp::from_seconds(t_s), lift(pose)});
      ImuSample sample;
      sample.stamp = Stamp::from_seconds(t_s);
      sample.specific_force_mps2 = {0, 0, 9.81};
      const double turn = wrap_angle(true_pose(r, t_s + 0.1).angle() - true_pose(r, t_s - 0.1).angle());
      sample.angular_rate_radps = {0, 0, turn / 0.2 + 0.002 * random_.normal()};
      robot.inertial.push_back(sample);
    }
    robot.odometry = Trajectory<SE3>(std::move(poses));
    for (double t_s = 2; t_s < kDuration_s - 1; t_s += 2) robot.wifi.push_back(scan(r, t_s));
    mission_.robots.push_back(std::move(robot));
  }

  WifiScan scan(std::size_t r, double t_s) {
    WifiScan scan{Stamp::from_seconds(t_s), {}};
    for (std::size_t k = 0; k < mission_.access_points.size(); ++k) {
      const double angle = 2.4 * static_cast<double>(k), radius = 8 * std::sqrt(static_cast<double>(k));
      const double d = distance_to(radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), r, t_s);
      const double rssi_dbm = std::round(-32 - 30 * std::log10(1 + d) + 2 * random_.normal());
      if (rssi_dbm > -85) scan.readings.push_back({AccessPointIndex(k), 2412, static_cast<float>(rssi_dbm)});
    }
    return scan;
  }

  void add_links(double t_s) {
    for (std::size_t i = 0; i < kRobots; ++i)
      for (std::size_t j = i + 1; j < kRobots; ++j) {
        RangeMeasurement range;
        range.stamp = Stamp::from_seconds(t_s);
        range.i.robot = RobotIndex(i);
        range.j.robot = RobotIndex(j);
        range.range_m =
            std::max(0.0, distance_to(true_pose(j, t_s).translation(), i, t_s) + 0.2 * random_.normal());
        range.sigma_m = 0.2;
        mission_.ranges.push_back(range);
        add_angle(t_s, i, j);
        add_angle(t_s, j, i);
      }
  }

  void add_angle(double t_s, std::size_t receiver, std::size_t transmitter) {
    const auto direction = true_pose(receiver, t_s).inverse() * true_pose(transmitter, t_s).translation();
    const double azimuth_rad = wrap_angle(std::atan2(direction.y(), direction.x()) + 0.05 * random_.normal());
    AoaMeasurement angle{Stamp::from_seconds(t_s), RobotIndex(receiver), {}, {}};
    angle.transmitter.robot = RobotIndex(transmitter);
    angle.paths.push_back({azimuth_rad, std::nullopt, 0.05, 0});
    angle.paths.push_back({wrap_angle(6.28 * random_.uniform()), std::nullopt, 0.05, -4});
    mission_.aoa_measurements.push_back(angle);
  }

  Mission mission_;
  Rng random_;
};

}  // namespace radioslam

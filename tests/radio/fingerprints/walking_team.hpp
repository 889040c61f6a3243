// Simulated team of walking robots among access points with log-distance path loss.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam::test {

/// An access point with its index in the mission.
struct AccessPoint {
  AccessPointIndex index;
  Eigen::Vector2d position;
};

/// Access points distributed uniformly over a rectangle.
inline std::vector<AccessPoint> distribute_access_points(std::size_t first, std::size_t count,
                                                         const Eigen::Vector2d& size_m, Rng rng) {
  std::vector<AccessPoint> access_points;
  for (std::size_t i = 0; i < count; ++i)
    access_points.push_back(
        {AccessPointIndex(first + i), {rng.uniform(0, size_m.x()), rng.uniform(0, size_m.y())}});
  return access_points;
}

/// Scan with -35 dBm at 1 m, 30 dB per decade, 2 dB of fading, and a detection threshold of -85 dBm.
inline WifiScan scan_at(const Eigen::Vector2d& place, Stamp stamp,
                        const std::vector<AccessPoint>& access_points, Rng& rng) {
  WifiScan scan{stamp, {}};
  for (const auto& [index, position] : access_points) {
    const double distance = std::max(1.0, (position - place).norm());
    const double rss = -35 - 30 * std::log10(distance) + rng.normal(0, 2);
    if (rss > -85) scan.readings.push_back({index, 2437, static_cast<float>(rss)});
  }
  return scan;
}

/// T_common_body once per second at 1 m/s, between random waypoints in the rectangle.
inline std::vector<SE2> draw_walk(int seconds, const Eigen::Vector2d& size_m, Rng rng) {
  const auto draw_place = [&] {
    return Eigen::Vector2d(rng.uniform(0, size_m.x()), rng.uniform(0, size_m.y()));
  };
  std::vector<SE2> poses;
  Eigen::Vector2d place = draw_place(), target = draw_place();
  while (poses.size() < static_cast<std::size_t>(seconds)) {
    while ((target - place).norm() < 2) target = draw_place();
    const Eigen::Vector2d ahead = (target - place).normalized();
    poses.emplace_back(place, std::atan2(ahead.y(), ahead.x()));
    place += ahead;
  }
  return poses;
}

/// Robot with perfect odometry along a walk and a scan every other second. With absolute heading the odometry
/// keeps the common frame's directions; with relative heading it starts at the identity.
inline Robot walk_and_scan(const std::vector<SE2>& walk, Heading heading,
                           const std::vector<AccessPoint>& access_points, Rng rng) {
  const SE2 T_common_start =
      heading == Heading::kRelative ? walk.front() : SE2(walk.front().translation(), 0);
  Robot robot;
  robot.heading = heading;
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t t = 0; t < walk.size(); ++t) {
    const Stamp stamp = Stamp::from_seconds(static_cast<double>(t));
    rows.push_back({stamp, lift(T_common_start.inverse() * walk[t])});
    if (t % 2 == 0) robot.wifi.push_back(scan_at(walk[t].translation(), stamp, access_points, rng));
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  return robot;
}

/// A mission and its true trajectories.
struct WalkingTeam {
  Mission mission;
  std::vector<std::vector<SE2>> walks;
};

/// Adds robots in a rectangle of their own, with access points of their own.
inline void add_walkers(WalkingTeam& team, int robots, Heading heading, int seconds, const Rng& rng) {
  const Eigen::Vector2d size_m(60, 40);
  constexpr std::size_t kAccessPoints = 25;
  Mission& mission = team.mission;
  const auto access_points = distribute_access_points(mission.access_points.size(), kAccessPoints, size_m,
                                                      rng.split("access points"));
  for (std::size_t i = 0; i < kAccessPoints; ++i)
    mission.access_points.push_back("ap " + std::to_string(100 + mission.access_points.size()));
  for (int r = 0; r < robots; ++r) {
    const Rng own = rng.split(static_cast<std::uint64_t>(r));
    team.walks.push_back(draw_walk(seconds, size_m, own.split("walk")));
    mission.robots.push_back(walk_and_scan(team.walks.back(), heading, access_points, own.split("scans")));
    mission.robots.back().id = "robot " + std::to_string(mission.robots.size());
  }
}

inline WalkingTeam walking_team(int robots, Heading heading, int seconds, std::uint64_t seed) {
  WalkingTeam team;
  add_walkers(team, robots, heading, seconds, Rng(seed));
  return team;
}

}  // namespace radioslam::test

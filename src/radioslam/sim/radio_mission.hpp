// From true ways to a mission of robots that hear each other: what city, hall and kitti share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/sim/aliased_matches.hpp"
#include "radioslam/sim/radio_channel.hpp"
#include "radioslam/sim/simulation.hpp"

namespace radioslam {

/// A robot's way and what its odometry made of it.
struct DrivenRobot {
  Trajectory<SE3> truth;     ///< T_common_body
  Trajectory<SE3> odometry;  ///< T_start_body
  OdometryNoise noise;
  std::optional<double> sigma_heading_rad = {};  ///< the odometry's heading is absolute, up to this error
};

/// What a radio mission is made of beside its robots.
struct RadioMissionParams {
  std::string name;
  int dimension = 2;
  double lidar_range_m = 30;
  RadioChannelParams radio;
  AliasedMatchParams matches;
  DrawAlias draw_alias;
};

/// Robots a, b, ... of unknown starts, their links, and matches within twice the LiDAR's range.
Simulation make_radio_mission(std::vector<DrivenRobot> robots, const RadioMissionParams& params,
                              const Rng& rng);

}  // namespace radioslam

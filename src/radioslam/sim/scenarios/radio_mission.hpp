// Radio mission: builds the mission of a team with radio links from true trajectories, for city, hall and
// kitti.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/aliased_matches.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"

namespace radioslam {

/// A robot's true trajectory and its odometry.
struct DrivenRobot {
  Trajectory<SE3> truth;     ///< T_common_body
  Trajectory<SE3> odometry;  ///< T_start_body
  OdometryNoise noise;
  std::optional<double> sigma_heading_rad = {};  ///< the odometry's heading is absolute, with this error
};

/// The parts of a radio mission apart from its robots.
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

// A town whose streets robots drive, partly the same ones: drifting odometry, unknown starts, radio links.
//
// After the tests of Wi-Closure (range and angle at both ends, 0.5 m and 10 degrees, LiDAR of 30 m). The
// odometry is a random walk without constant errors by default. In three dimensions the ground has gentle
// hills, angles have an elevation, and the odometry's height drifts. With lidar_beams robots scan the ground
// and the houses along the streets (town_houses.hpp); with imu_hz they ride smoothly (onboard_sensors.hpp);
// with gnss_hz they get position fixes (gnss_receiver.hpp).
// At the default speed a corner is taken at 1.5 g: speed_mps=4 is a car's.
#pragma once

#include <cstdint>

#include "radioslam/sim/aliased_matches.hpp"
#include "radioslam/sim/gnss_receiver.hpp"
#include "radioslam/sim/onboard_sensors.hpp"
#include "radioslam/sim/radio_channel.hpp"
#include "radioslam/sim/simulation.hpp"
#include "radioslam/sim/street_grid.hpp"
#include "radioslam/sim/town_houses.hpp"
#include "radioslam/sim/wheel_odometry.hpp"

namespace radioslam {

/// Dead reckoning that is a pure random walk, wherever it ends.
inline WheelOdometryParams random_walk_odometry() {
  WheelOdometryParams odometry;
  odometry.odometry_rate_hz = 10;
  odometry.sigma_yaw_drift_per_m_rad = 0;
  odometry.sigma_scale = 0;
  odometry.end_error_min_m = 0;
  odometry.end_error_max_m = 1e6;
  odometry.draws = 1;
  return odometry;
}

/// A scanner on the roof of a car.
inline OnboardParams roof_sensors() {
  OnboardParams onboard;
  onboard.lidar.lidar_height_m = 1.7;
  return onboard;
}

/// Everything about a town's mission. Field names are unique over all parts.
struct CityParams {
  int robots = 2;
  int dimension = 2;
  double path_length_m = 1700;
  double speed_mps = 11;
  double corner_radius_m = 8;
  double sigma_wander_m = 0.3;
  double least_meeting_s = 24;
  double lidar_range_m = 30;
  bool absolute_heading = false;
  double sigma_heading_rad = 0.05;
  double sigma_height_m = 4;
  double sigma_z_per_sqrt_m = 0.01;
  OnboardParams onboard = roof_sensors();
  GnssReceiverParams gnss;
  StreetGridParams streets;
  TownHouseParams houses;
  WheelOdometryParams odometry = random_walk_odometry();
  RadioChannelParams radio;
  AliasedMatchParams matches;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"robots", "", 1, 26, "robots in the team"}, self.robots);
    visit(Field{"dimension", "", 2, 3, "2: a plane; 3: gentle hills"}, self.dimension);
    visit(Field{"path_length_m", "m", 10, 1e6, "way of each robot"}, self.path_length_m);
    visit(Field{"speed_mps", "m/s", 0.1, 50, "speed; 11 gives a keyframe per odometry pose"}, self.speed_mps);
    visit(Field{"corner_radius_m", "m", 1, 20, "radius of the arc around a corner"}, self.corner_radius_m);
    visit(Field{"sigma_wander_m", "m", 0, 0.6, "standard deviation of the sideways wander on a street"},
          self.sigma_wander_m);
    visit(Field{"least_meeting_s", "s", 0, 1e6,
                "routes are drawn until each robot is in range of an earlier one so long, spread"},
          self.least_meeting_s);
    visit(Field{"lidar_range_m", "m", 0.1, 1000, "range of every robot's LiDAR"}, self.lidar_range_m);
    visit(Field{"absolute_heading", "", 0, 1, "whether a compass gives each robot its heading at the start"},
          self.absolute_heading);
    visit(Field{"sigma_heading_rad", "rad", 0.0001, 3, "error of that heading, constant per robot"},
          self.sigma_heading_rad);
    visit(Field{"sigma_height_m", "m", 0, 20, "standard deviation of the ground's height, in 3D"},
          self.sigma_height_m);
    visit(Field{"sigma_z_per_sqrt_m", "m/sqrt(m)", 0, 1, "white noise of the odometry's height, in 3D"},
          self.sigma_z_per_sqrt_m);
    OnboardParams::visit_fields(self.onboard, visit);
    GnssReceiverParams::visit_fields(self.gnss, visit);
    StreetGridParams::visit_fields(self.streets, visit);
    TownHouseParams::visit_fields(self.houses, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
    AliasedMatchParams::visit_fields(self.matches, visit);
  }
};

/// The same seed gives the same mission; another robot leaves the others and their links as they are.
Simulation simulate_city(const CityParams& params, std::uint64_t seed);

}  // namespace radioslam

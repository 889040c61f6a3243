// City scenario: robots drive partly overlapping streets of a town, with drifting odometry, unknown starts
// and radio links.
//
// After the tests of Wi-Closure (Wang et al.): range and angle at both ends, 0.5 m and 10 degrees, LiDAR of
// 30 m. By default the odometry is a random walk without constant errors. In three dimensions the ground is
// hilly, angles have an elevation, and the odometry's height drifts. With lidar_beams robots scan the ground
// and the houses along the streets (town_houses.hpp); with imu_hz their motion is smooth
// (onboard_sensors.hpp); with gnss_hz they have position fixes (gnss_receiver.hpp). At the default speed
// corners are taken at 1.5 g; speed_mps=4 is realistic for a car.
#pragma once

#include <cstdint>

#include "radioslam/sim/scenarios/onboard_sensors.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/aliased_matches.hpp"
#include "radioslam/sim/sensors/gnss_receiver.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"
#include "radioslam/sim/worlds/town_houses.hpp"

namespace radioslam {

/// Dead reckoning as a pure random walk with any end error.
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

/// Sensors on the roof of a car.
inline OnboardParams roof_sensors() {
  OnboardParams onboard;
  onboard.lidar.lidar_height_m = 1.7;
  return onboard;
}

/// All parameters of a city mission. Field names are unique over all parts.
struct CityParams {
  int robots = 2;
  int dimension = 2;
  double path_length_m = 1700;
  double speed_mps = 11;
  double corner_radius_m = 8;
  double sigma_wander_m = 0.3;
  double min_contact_s = 24;
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
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100, "number of robots in the team");
    RADIOSLAM_BASIC_FIELD(dimension, "", 2, 3, "dimension of the mission: 2 for a plane, 3 for gentle hills");
    RADIOSLAM_BASIC_FIELD(path_length_m, "m", 10, 1e6, "path length of each robot");
    RADIOSLAM_FIELD(speed_mps, "m/s", 0.1, 50, "driving speed; 11 gives one keyframe per odometry sample");
    RADIOSLAM_FIELD(corner_radius_m, "m", 1, 20, "radius of the arcs around corners");
    RADIOSLAM_FIELD(sigma_wander_m, "m", 0, 0.6, "standard deviation of the sideways wander on a street");
    RADIOSLAM_FIELD(
        min_contact_s, "s", 0, 1e6,
        "smallest time, spread over the mission, that each robot's route is in range of an earlier robot's");
    RADIOSLAM_BASIC_FIELD(lidar_range_m, "m", 0.1, 1000, "range of every robot's LiDAR");
    RADIOSLAM_FIELD(absolute_heading, "", 0, 1, "whether a compass measures each robot's initial heading");
    RADIOSLAM_FIELD(sigma_heading_rad, "rad", 0.0001, 3,
                    "standard deviation of the compass heading, constant per robot");
    RADIOSLAM_FIELD(sigma_height_m, "m", 0, 20, "standard deviation of the ground's height, in 3D");
    RADIOSLAM_FIELD(sigma_z_per_sqrt_m, "m/sqrt(m)", 0, 1, "white noise of the odometry's height, in 3D");
    OnboardParams::visit_fields(self.onboard, visit);
    GnssReceiverParams::visit_fields(self.gnss, visit);
    StreetGridParams::visit_fields(self.streets, visit);
    TownHouseParams::visit_fields(self.houses, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
    AliasedMatchParams::visit_fields(self.matches, visit);
  }
};

/// The same seed gives the same mission; adding a robot leaves the others and their links unchanged.
Simulation simulate_city(const CityParams& params, std::uint64_t seed);

}  // namespace radioslam

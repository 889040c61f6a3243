// Corridor scenario: featureless corridors in which scan matching leaves the position along them unobservable
// and an inertial unit is needed.
//
// Four rooms at the corners of a rectangle are joined by four straight corridors with smooth walls, floor and
// ceiling: two long ones along x and two shorter ones. In the middle of a long corridor, more than
// `lidar_range_m` from both rooms, a LiDAR sees only planes parallel to it. Rooms contain crates and pillars.
// Robots drive around the building counter-clockwise, from the centres of different rooms, the first two from
// opposite ones into long corridors; each ends in the room where the other began. Frame: origin at the first
// room's centre, x along the long corridors. Walls are transparent to radio.
#pragma once

#include <cstdint>

#include "radioslam/base/fields.hpp"
#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/onboard_sensors.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"

namespace radioslam {

inline OnboardParams corridor_sensors() {
  OnboardParams onboard;
  onboard.lidar.lidar_beams = 16;
  onboard.lidar.lidar_azimuth_steps = 600;
  onboard.lidar.lidar_min_range_m = 0.3;
  onboard.inertial.imu_hz = 200;
  onboard.ride.speed_swing = 0.4;
  onboard.ride.sway_rad = 0.01;
  return onboard;
}

inline RadioChannelParams corridor_radio() {
  RadioChannelParams radio;
  radio.sigma_range_m = 0.3;
  return radio;
}

/// All parameters of a corridor mission. Field names are unique over all parts.
struct CorridorsParams {
  int robots = 2;
  double corridor_m = 85;
  double cross_corridor_m = 30;
  double corridor_width_m = 2;
  double room_m = 8;
  double ceiling_m = 2.8;
  int things_per_room = 8;
  double path_length_m = 135;
  double speed_mps = 1.5;
  double sigma_wander_m = 0.1;
  double lidar_range_m = 20;
  bool wheel_odometry = false;
  double sigma_z_per_sqrt_m = 0.01;
  OnboardParams onboard = corridor_sensors();
  WheelOdometryParams odometry = random_walk_odometry();
  RadioChannelParams radio = corridor_radio();

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100, "number of robots in the team");
    RADIOSLAM_BASIC_FIELD(corridor_m, "m", 5, 10000, "length of the two long corridors, from room to room");
    RADIOSLAM_FIELD(cross_corridor_m, "m", 5, 10000, "length of the two short corridors, from room to room");
    RADIOSLAM_FIELD(corridor_width_m, "m", 1.5, 5, "width of the corridors");
    RADIOSLAM_FIELD(room_m, "m", 6, 100, "side of the square rooms at the corners");
    RADIOSLAM_FIELD(ceiling_m, "m", 1, 100, "height of the ceiling");
    RADIOSLAM_FIELD(things_per_room, "", 0, 1000, "number of crates and pillars in each room");
    RADIOSLAM_BASIC_FIELD(path_length_m, "m", 5, 1e6, "path length of each robot");
    RADIOSLAM_BASIC_FIELD(speed_mps, "m/s", 0.05, 10, "mean driving speed");
    RADIOSLAM_FIELD(sigma_wander_m, "m", 0, 0.2, "standard deviation of the sideways wander");
    RADIOSLAM_BASIC_FIELD(lidar_range_m, "m", 0.1, 1000, "range of every robot's LiDAR");
    RADIOSLAM_BASIC_FIELD(wheel_odometry, "", 0, 1,
                          "whether there is wheel odometry; always if there are no scans");
    RADIOSLAM_FIELD(sigma_z_per_sqrt_m, "m/sqrt(m)", 0, 1, "white noise of the wheel odometry's height");
    OnboardParams::visit_fields(self.onboard, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
  }
};

/// The building with its furniture.
WorldShapes corridor_shapes(const CorridorsParams& params, std::uint64_t seed);

/// The same seed gives the same mission; adding a robot leaves the others unchanged.
Simulation simulate_corridors(const CorridorsParams& params, std::uint64_t seed);

}  // namespace radioslam

// A building of corridors without features: where a LiDAR does not see how far along it is, and an inertial
// unit has to say.
//
// Four rooms at the corners of a rectangle, joined by four straight corridors of smooth walls, floor and
// ceiling: two long ones along x and two shorter ones. Over the middle of a long corridor, all but the last
// `lidar_range_m` before either room, a LiDAR sees nothing but planes along it. Rooms hold crates and
// pillars. Robots drive round the building counter-clockwise, from the centres of different rooms, the first
// two from opposite ones into long corridors; each ends in the room where the other began. Frame: origin at
// the first room's centre, x along the long corridors. Walls let radio through.
#pragma once

#include <cstdint>

#include "radioslam/base/fields.hpp"
#include "radioslam/sim/city.hpp"
#include "radioslam/sim/onboard_sensors.hpp"
#include "radioslam/sim/radio_channel.hpp"
#include "radioslam/sim/ray_world.hpp"
#include "radioslam/sim/simulation.hpp"
#include "radioslam/sim/wheel_odometry.hpp"

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

/// Everything about such a mission. Field names are unique over all parts.
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
    visit(Field{"robots", "", 1, 26, "robots in the team"}, self.robots);
    visit(Field{"corridor_m", "m", 5, 10000, "length of the two long corridors, from room to room"},
          self.corridor_m);
    visit(Field{"cross_corridor_m", "m", 5, 10000, "length of the two others"}, self.cross_corridor_m);
    visit(Field{"corridor_width_m", "m", 1.5, 5, "between the walls of a corridor"}, self.corridor_width_m);
    visit(Field{"room_m", "m", 6, 100, "sides of the rooms at the corners"}, self.room_m);
    visit(Field{"ceiling_m", "m", 1, 100, "height of the ceiling"}, self.ceiling_m);
    visit(Field{"things_per_room", "", 0, 1000, "crates and pillars in each room"}, self.things_per_room);
    visit(Field{"path_length_m", "m", 5, 1e6, "way of each robot"}, self.path_length_m);
    visit(Field{"speed_mps", "m/s", 0.05, 10, "mean speed"}, self.speed_mps);
    visit(Field{"sigma_wander_m", "m", 0, 0.2, "standard deviation of the sideways wander"},
          self.sigma_wander_m);
    visit(Field{"lidar_range_m", "m", 0.1, 1000, "range of every robot's LiDAR"}, self.lidar_range_m);
    visit(
        Field{"wheel_odometry", "", 0, 1, "whether wheels measure the way; always where there are no scans"},
        self.wheel_odometry);
    visit(Field{"sigma_z_per_sqrt_m", "m/sqrt(m)", 0, 1, "white noise of the wheel odometry's height"},
          self.sigma_z_per_sqrt_m);
    OnboardParams::visit_fields(self.onboard, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
  }
};

/// The building with what stands in it.
WorldShapes corridor_shapes(const CorridorsParams& params, std::uint64_t seed);

/// The same seed gives the same mission; another robot leaves the others as they are.
Simulation simulate_corridors(const CorridorsParams& params, std::uint64_t seed);

}  // namespace radioslam

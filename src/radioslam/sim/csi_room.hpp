// A room with reflecting walls in which robots take turns to drive, and their WiFi cards talk meanwhile.
//
// While one robot drives its leg, it asks all others in turn, again and again, and each answers: every leg
// makes one measurement of the direction to every robot that stands. Angles alone leave the scale of the team
// open, so a few ranges come with them. Frame: origin at a corner of the room, x along its first side; two
// inner walls reach halfway into it, so that some robots are hidden from some others. Robots drive in the
// plane, each with its antennas in a row across. Counters run on over the legs, one per round of packets, as
// in the recordings of the WSR toolbox.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/sim/city.hpp"
#include "radioslam/sim/csi_card.hpp"
#include "radioslam/sim/image_sources.hpp"
#include "radioslam/sim/simulation.hpp"
#include "radioslam/sim/turn_drives.hpp"
#include "radioslam/sim/wheel_odometry.hpp"

namespace radioslam {

/// Dead reckoning good enough for an array of antennas: a few millimetres over a leg, as a tracking camera's.
inline WheelOdometryParams array_odometry() {
  WheelOdometryParams odometry = random_walk_odometry();
  odometry.odometry_rate_hz = 20;
  odometry.sigma_xy_per_sqrt_m = 0.003;
  odometry.sigma_yaw_per_rad = 0.005;
  return odometry;
}

/// Channels of 20 MHz.
inline constexpr const char* kCsiChannels =
    "1|2|3|4|5|6|7|8|9|10|11|12|13|36|40|44|48|52|56|60|64|100|104|108|112|116|120|124|128|132|136|140|149|"
    "153|157|161|165";

/// Everything about such a mission. Field names are unique over all parts.
struct CsiRoomParams {
  int robots = 3;
  double room_x_m = 16;
  double room_y_m = 11;
  int inner_walls = 2;
  double wall_reflection = -0.4;
  double wall_loss_db = 8;
  int most_bounces = 2;
  double obstruction_db = 0;
  std::string channel = "108";
  int antennas = 1;
  double antenna_forward_m = 0.15;
  double antenna_height_m = 0.3;
  double antenna_spacing_m = 0.027;
  double packet_rate_hz = 120;
  double standing_s = 0.3;
  int ranges_per_pair = 6;
  double sigma_range_m = 0.1;
  double lidar_range_m = 8;
  TurnDriveParams drives;
  WheelOdometryParams odometry = array_odometry();
  CsiCardParams cards;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"robots", "", 1, 26, "robots in the team"}, self.robots);
    visit(Field{"room_x_m", "m", 3, 200, "first side of the room"}, self.room_x_m);
    visit(Field{"room_y_m", "m", 3, 200, "second side of the room"}, self.room_y_m);
    visit(Field{"inner_walls", "", 0, 2, "pieces of wall that reach halfway into the room"},
          self.inner_walls);
    visit(Field{"wall_reflection", "", -1, 1, "of the amplitude; -0.4 is plasterboard or concrete"},
          self.wall_reflection);
    visit(Field{"wall_loss_db", "dB", 0, 60, "of what passes through a wall"}, self.wall_loss_db);
    visit(Field{"most_bounces", "", 0, 2, "of a path off walls"}, self.most_bounces);
    visit(Field{"obstruction_db", "dB", 0, 100, "loss of every direct path beside that of walls"},
          self.obstruction_db);
    visit(Field{"channel", "", 0, 0, "of the WiFi; that of published recordings", kCsiChannels},
          self.channel);
    visit(Field{"antennas", "", 1, 3, "of every card; the first one sends"}, self.antennas);
    visit(Field{"antenna_forward_m", "m", -5, 5, "the row of antennas in the body frame: its x"},
          self.antenna_forward_m);
    visit(Field{"antenna_height_m", "m", 0, 5, "its z"}, self.antenna_height_m);
    visit(Field{"antenna_spacing_m", "m", 0.001, 1, "between neighbours in it; half a wavelength"},
          self.antenna_spacing_m);
    visit(Field{"packet_rate_hz", "Hz", 1, 300, "packets to every robot; 120 in recordings"},
          self.packet_rate_hz);
    visit(Field{"standing_s", "s", 0, 5, "packets begin so long before a leg and end after it"},
          self.standing_s);
    visit(Field{"ranges_per_pair", "", 0, 1000, "distances per pair of robots, between their bodies"},
          self.ranges_per_pair);
    visit(Field{"sigma_range_m", "m", 0.001, 100, "their noise"}, self.sigma_range_m);
    visit(Field{"lidar_range_m", "m", 0.1, 1000, "range of every robot's LiDAR"}, self.lidar_range_m);
    TurnDriveParams::visit_fields(self.drives, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    CsiCardParams::visit_fields(self.cards, visit);
  }
};

/// The walls of the room.
std::vector<WallSegment> walls_of(const CsiRoomParams& params);

/// The same seed gives the same mission.
Simulation simulate_csi_room(const CsiRoomParams& params, std::uint64_t seed);

}  // namespace radioslam

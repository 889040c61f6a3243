// CSI room scenario: robots take turns to drive in a room with reflecting walls, and their WiFi cards
// exchange packets meanwhile.
//
// While one robot drives its leg, it repeatedly sends packets to all others, and each answers: every leg
// gives one angle measurement to every robot at rest. Angles alone leave the team's scale unobservable, so a
// few ranges are added. Frame: origin at a corner of the room, x along its first side; two inner walls reach
// halfway into it, so that some robots are not in line of sight. Robots drive in the plane, each with a
// lateral row of antennas. Counters continue over the legs, one per round of packets, as in the recordings of
// the WSR toolbox.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/sim/motion/take_turns.hpp"
#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/csi_card.hpp"
#include "radioslam/sim/sensors/image_sources.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"

namespace radioslam {

/// Dead reckoning accurate enough for a synthetic antenna array: a few millimetres per leg, like a tracking
/// camera.
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

/// All parameters of such a mission. Field names are unique over all parts.
struct CsiRoomParams {
  int robots = 3;
  double room_x_m = 16;
  double room_y_m = 11;
  int inner_walls = 2;
  double wall_reflection = -0.4;
  double wall_loss_db = 8;
  int max_bounces = 2;
  double obstruction_db = 0;
  std::string channel = "108";
  int antennas = 1;
  double antenna_forward_m = 0.15;
  double antenna_height_m = 0.3;
  double antenna_spacing_m = 0.027;
  double packet_rate_hz = 120;
  double packet_margin_s = 0.3;
  int ranges_per_pair = 6;
  double sigma_range_m = 0.1;
  double lidar_range_m = 8;
  TurnDriveParams drives;
  WheelOdometryParams odometry = array_odometry();
  CsiCardParams cards;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"robots", "", 1, 100, "number of robots in the team"}.basic(), self.robots);
    visit(Field{"room_x_m", "m", 3, 200, "length of the room along x"}.basic(), self.room_x_m);
    visit(Field{"room_y_m", "m", 3, 200, "length of the room along y"}.basic(), self.room_y_m);
    visit(Field{"inner_walls", "", 0, 2, "number of walls that reach halfway into the room"},
          self.inner_walls);
    visit(Field{"wall_reflection", "", -1, 1,
                "amplitude reflection coefficient of walls; -0.4 for plasterboard or concrete"},
          self.wall_reflection);
    visit(Field{"wall_loss_db", "dB", 0, 60, "transmission loss of a wall"}, self.wall_loss_db);
    visit(Field{"max_bounces", "", 0, 2, "largest number of wall reflections of a path"}.basic(),
          self.max_bounces);
    visit(Field{"obstruction_db", "dB", 0, 100, "loss of every direct path in addition to that of walls"}
              .basic(),
          self.obstruction_db);
    visit(Field{"channel", "", 0, 0, "WiFi channel (default: that of published recordings)", kCsiChannels},
          self.channel);
    visit(Field{"antennas", "", 1, 3, "number of antennas of every card; the first one sends"}.basic(),
          self.antennas);
    visit(Field{"antenna_forward_m", "m", -5, 5, "x of the antenna row in the body frame"},
          self.antenna_forward_m);
    visit(Field{"antenna_height_m", "m", 0, 5, "z of the antenna row in the body frame"},
          self.antenna_height_m);
    visit(Field{"antenna_spacing_m", "m", 0.001, 1,
                "spacing of adjacent antennas (default: half a wavelength)"},
          self.antenna_spacing_m);
    visit(Field{"packet_rate_hz", "Hz", 1, 300, "packet rate to every robot; 120 in published recordings"}
              .basic(),
          self.packet_rate_hz);
    visit(
        Field{"packet_margin_s", "s", 0, 5, "time before and after a leg during which packets are also sent"},
        self.packet_margin_s);
    visit(Field{"ranges_per_pair", "", 0, 1000,
                "number of ranges per pair of robots, between their body origins"}
              .basic(),
          self.ranges_per_pair);
    visit(Field{"sigma_range_m", "m", 0.001, 100, "standard deviation of ranges"}.basic(),
          self.sigma_range_m);
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

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
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100, "number of robots in the team");
    RADIOSLAM_BASIC_FIELD(room_x_m, "m", 3, 200, "length of the room along x");
    RADIOSLAM_BASIC_FIELD(room_y_m, "m", 3, 200, "length of the room along y");
    RADIOSLAM_FIELD(inner_walls, "", 0, 2, "number of walls that reach halfway into the room");
    RADIOSLAM_FIELD(wall_reflection, "", -1, 1,
                    "amplitude reflection coefficient of walls; -0.4 for plasterboard or concrete");
    RADIOSLAM_FIELD(wall_loss_db, "dB", 0, 60, "transmission loss of a wall");
    RADIOSLAM_BASIC_FIELD(max_bounces, "", 0, 2, "largest number of wall reflections of a path");
    RADIOSLAM_BASIC_FIELD(obstruction_db, "dB", 0, 100,
                          "loss of every direct path in addition to that of walls");
    RADIOSLAM_FIELD(channel, "", 0, 0, "WiFi channel (default: that of published recordings)", kCsiChannels);
    RADIOSLAM_BASIC_FIELD(antennas, "", 1, 3, "number of antennas of every card; the first one sends");
    RADIOSLAM_FIELD(antenna_forward_m, "m", -5, 5, "x of the antenna row in the body frame");
    RADIOSLAM_FIELD(antenna_height_m, "m", 0, 5, "z of the antenna row in the body frame");
    RADIOSLAM_FIELD(antenna_spacing_m, "m", 0.001, 1,
                    "spacing of adjacent antennas (default: half a wavelength)");
    RADIOSLAM_BASIC_FIELD(packet_rate_hz, "Hz", 1, 300,
                          "packet rate to every robot; 120 in published recordings");
    RADIOSLAM_FIELD(packet_margin_s, "s", 0, 5,
                    "time before and after a leg during which packets are also sent");
    RADIOSLAM_BASIC_FIELD(ranges_per_pair, "", 0, 1000,
                          "number of ranges per pair of robots, between their body origins");
    RADIOSLAM_BASIC_FIELD(sigma_range_m, "m", 0.001, 100, "standard deviation of ranges");
    RADIOSLAM_FIELD(lidar_range_m, "m", 0.1, 1000, "range of every robot's LiDAR");
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

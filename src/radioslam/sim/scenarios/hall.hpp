// Hall scenario: two robots between identical pillars, with a LiDAR of 10 m, radio everywhere and very few
// links.
//
// After the hardware test of Wi-Closure (Wang et al.): 25 x 23 m, a range and the angles at one end about
// every 10 m, four in all, with 17 false paths among 3 direct ones; 1,848 matches, most of them wrong by
// whole pillar spacings. Frame: origin at a corner, x along the long side; robots drive the aisles between
// the pillars. With lidar_beams they scan walls, floor, ceiling and pillars; with imu_hz their motion is
// smooth (onboard_sensors.hpp).
#pragma once

#include <cstdint>

#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/onboard_sensors.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/aliased_matches.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"

namespace radioslam {

inline RadioChannelParams hall_radio() {
  RadioChannelParams radio;
  radio.links = 4;
  radio.angle_ends = "one";
  radio.missing_direct_ratio = 0.25;
  radio.min_false_paths = 4;
  radio.max_false_paths = 5;
  radio.sigma_range_m = 0.2;
  radio.mirror_section_m = 10;
  radio.mirror_distance_m = 3;
  return radio;
}

/// All parameters of a hall mission. Field names are unique over all parts.
struct HallParams {
  int robots = 2;
  double hall_x_m = 25;
  double hall_y_m = 23;
  double pillar_spacing_m = 5;
  double pillar_radius_m = 0.3;
  double hall_height_m = 4;
  double path_length_m = 45;
  double speed_mps = 0.5;
  double lidar_range_m = 10;
  OnboardParams onboard;
  WheelOdometryParams odometry = random_walk_odometry();
  RadioChannelParams radio = hall_radio();
  AliasedMatchParams matches{115, 1733, 12};

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100, "number of robots in the team");
    RADIOSLAM_BASIC_FIELD(hall_x_m, "m", 5, 500, "long side of the hall");
    RADIOSLAM_BASIC_FIELD(hall_y_m, "m", 5, 500, "short side of the hall");
    RADIOSLAM_FIELD(pillar_spacing_m, "m", 2, 50, "spacing of the pillars");
    RADIOSLAM_FIELD(pillar_radius_m, "m", 0.05, 0.5, "radius of the pillars, if they are scanned");
    RADIOSLAM_FIELD(hall_height_m, "m", 2, 100, "height of walls, pillars and ceiling, if they are scanned");
    RADIOSLAM_BASIC_FIELD(path_length_m, "m", 5, 1e5, "path length of each robot");
    RADIOSLAM_FIELD(speed_mps, "m/s", 0.05, 10, "driving speed");
    RADIOSLAM_BASIC_FIELD(lidar_range_m, "m", 0.1, 1000, "range of every robot's LiDAR");
    OnboardParams::visit_fields(self.onboard, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
    AliasedMatchParams::visit_fields(self.matches, visit);
  }
};

/// One large box, seen from inside, with pillars midway between the aisles.
WorldShapes hall_shapes(const HallParams& params);

Simulation simulate_hall(const HallParams& params, std::uint64_t seed);

}  // namespace radioslam

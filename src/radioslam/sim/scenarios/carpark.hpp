// Car park scenario with WiFi: robots drive its lanes with wheel odometry and a handful of phones each.
//
// After the test site of Liu et al., "Collaborative radio SLAM" (5,100 m^2, about 70 access points, 0.4 m/s,
// five phones scanning at 0.5 Hz, odometry with end errors of 10-20 m). The common frame is the floor's
// (lane_grid.hpp). Robots keep to the plane z = 0. The simulation is independent of the estimator's models.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/sim/motion/drive.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/phones.hpp"
#include "radioslam/sim/sensors/transmitters.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

/// All parameters of a car park mission. Field names are unique over all parts.
struct CarparkParams {
  int robots = 2;
  bool known_start = true;
  int known_access_points = 0;
  double truth_rate_hz = 2;
  LaneGridParams lanes;
  DriveParams drive;
  WheelOdometryParams odometry;
  TransmitterParams transmitters;
  PhoneParams phones;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100, "number of robots in the team");
    RADIOSLAM_BASIC_FIELD(known_start, "", 0, 1, "whether the mission contains each robot's start pose");
    RADIOSLAM_FIELD(known_access_points, "", 0, 60000,
                    "number of access points whose positions the mission states (radio/anchors.csv)");
    RADIOSLAM_FIELD(truth_rate_hz, "Hz", 0.01, 1000, "rate of the true poses");
    LaneGridParams::visit_fields(self.lanes, visit);
    DriveParams::visit_fields(self.drive, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    TransmitterParams::visit_fields(self.transmitters, visit);
    PhoneParams::visit_fields(self.phones, visit);
  }
};

/// The static world, the same for any number of robots.
struct CarparkWorld {
  LaneGrid lanes;
  std::vector<Transmitter> transmitters;  ///< in the order of Mission::access_points
};

CarparkWorld make_carpark_world(const CarparkParams& params, std::uint64_t seed);

/// A mission in that world. Robots start at different crossings, as long as there are enough. The same seed
/// gives the same mission; adding a robot leaves the others unchanged.
Simulation simulate_carpark(const CarparkParams& params, std::uint64_t seed);

}  // namespace radioslam

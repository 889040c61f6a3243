// A car park with WiFi: robots drive its lanes, each with wheel odometry and a handful of phones.
//
// After the test site of Liu et al., "Collaborative radio SLAM" (5,100 m^2, about 70 access points, 0.4 m/s,
// five phones scanning at 0.5 Hz, odometry that ends 10-20 m off). The common frame is the floor's
// (lane_grid.hpp). Robots keep to the plane z = 0. Nothing here knows how an estimator models any of it.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/sim/drive.hpp"
#include "radioslam/sim/lane_grid.hpp"
#include "radioslam/sim/phones.hpp"
#include "radioslam/sim/simulation.hpp"
#include "radioslam/sim/transmitters.hpp"
#include "radioslam/sim/wheel_odometry.hpp"

namespace radioslam {

/// Everything about a car park mission. Field names are unique over all parts.
struct CarparkParams {
  int robots = 2;
  bool known_start = true;
  double truth_rate_hz = 2;
  LaneGridParams lanes;
  DriveParams drive;
  WheelOdometryParams odometry;
  TransmitterParams transmitters;
  PhoneParams phones;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"robots", "", 1, 100, "robots in the team"}, self.robots);
    visit(Field{"known_start", "", 0, 1, "whether the mission states where each robot starts"},
          self.known_start);
    visit(Field{"truth_rate_hz", "Hz", 0.01, 1000, "true poses per second"}, self.truth_rate_hz);
    LaneGridParams::visit_fields(self.lanes, visit);
    DriveParams::visit_fields(self.drive, visit);
    WheelOdometryParams::visit_fields(self.odometry, visit);
    TransmitterParams::visit_fields(self.transmitters, visit);
    PhoneParams::visit_fields(self.phones, visit);
  }
};

/// What stands still: the same for any number of robots.
struct CarparkWorld {
  LaneGrid lanes;
  std::vector<Transmitter> transmitters;  ///< in the order of Mission::access_points
};

CarparkWorld make_carpark_world(const CarparkParams& params, std::uint64_t seed);

/// A mission through that world. Robots start at different crossings (as long as there are enough). The same
/// seed gives the same mission; another robot leaves the others as they are.
Simulation simulate_carpark(const CarparkParams& params, std::uint64_t seed);

}  // namespace radioslam

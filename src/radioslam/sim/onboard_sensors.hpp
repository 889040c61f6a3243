// What robots may carry beside radios and wheels, a LiDAR and an inertial unit, and the motion that suits
// them.
//
// Without an inertial unit robots keep the motion that their scenario gives them, whether they scan or not.
// With one they ride along it smoothly (smooth_ride.hpp): then everything, truth, odometry, links and scans,
// follows the smooth motion.
#pragma once

#include <memory>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/inertial_unit.hpp"
#include "radioslam/sim/lidar_scanner.hpp"
#include "radioslam/sim/ray_world.hpp"
#include "radioslam/sim/simulation.hpp"
#include "radioslam/sim/smooth_ride.hpp"
#include "radioslam/sim/true_motion.hpp"

namespace radioslam {

struct OnboardParams {
  double truth_hz = 0;
  LidarScannerParams lidar;
  InertialUnitParams inertial;
  SmoothRideParams ride;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"truth_hz", "Hz", 0, 1000, "true poses per second; 0: as many as of the odometry"},
          self.truth_hz);
    LidarScannerParams::visit_fields(self.lidar, visit);
    InertialUnitParams::visit_fields(self.inertial, visit);
    SmoothRideParams::visit_fields(self.ride, visit);
  }
};

/// How a robot moves along poses that a scenario drew for it.
struct RiddenWay {
  std::shared_ptr<const TrueMotion> motion;
  Trajectory<SE3> poses;  ///< the given ones, or those of the smooth motion at `rate_hz`
};
RiddenWay ride_along(Trajectory<SE3> way, double rate_hz, const OnboardParams& params, const Rng& rng);

/// Adds scans, inertial readings and finer truth to a mission of robots with these motions.
void add_onboard_sensors(Simulation& simulation,
                         const std::vector<std::shared_ptr<const TrueMotion>>& motions, WorldShapes world,
                         const OnboardParams& params, const Rng& rng);

}  // namespace radioslam

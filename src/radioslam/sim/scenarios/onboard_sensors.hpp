// Onboard sensors of simulated robots besides radio and wheels: a LiDAR, an inertial unit, and the motion for
// them.
//
// Without an inertial unit, robots keep the motion that their scenario gives them. With one, they follow it
// smoothly (smooth_motion.hpp), and truth, odometry, links and scans are all derived from the smooth motion.
#pragma once

#include <memory>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/motion/smooth_motion.hpp"
#include "radioslam/sim/motion/true_motion.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/inertial_unit.hpp"
#include "radioslam/sim/sensors/lidar_scanner.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"

namespace radioslam {

struct OnboardParams {
  double truth_hz = 0;
  LidarScannerParams lidar;
  InertialUnitParams inertial;
  SmoothMotionParams ride;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(truth_hz, "Hz", 0, 1000, "rate of the true poses; 0: that of the odometry");
    LidarScannerParams::visit_fields(self.lidar, visit);
    InertialUnitParams::visit_fields(self.inertial, visit);
    SmoothMotionParams::visit_fields(self.ride, visit);
  }
};

/// A robot's motion along the poses of its scenario.
struct RobotMotion {
  std::shared_ptr<const TrueMotion> motion;
  Trajectory<SE3> poses;  ///< the given ones, or those of the smooth motion at `rate_hz`
};
RobotMotion make_motion(Trajectory<SE3> trajectory, double rate_hz, const OnboardParams& params,
                        const Rng& rng);

/// Adds scans, IMU samples and truth at a higher rate to a mission of robots with these motions.
void add_onboard_sensors(Simulation& simulation,
                         const std::vector<std::shared_ptr<const TrueMotion>>& motions, WorldShapes world,
                         const OnboardParams& params, const Rng& rng);

}  // namespace radioslam

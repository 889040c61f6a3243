// A drive that was recorded, cut into two robots that drive at the same time, with simulated radio.
//
// After Wi-Closure's test on KITTI 08 (Geiger et al. 2012): the first part of the sequence is robot a, the
// rest is robot b; both start at time 0, each with its own real odometry in its own start frame. Links are
// simulated from the true poses. The LiDAR's range is half of the 35 m up to which a pair of places counts.
// The stated odometry noise was fitted to A-LOAM on sequence 00 (docs/defaults.md).
#pragma once

#include <cstdint>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/sim/aliased_matches.hpp"
#include "radioslam/sim/radio_channel.hpp"
#include "radioslam/sim/simulation.hpp"

namespace radioslam {

/// Everything about a recorded mission but the recording. Field names are unique over all parts.
struct KittiParams {
  double cut = 0.34;
  int dimension = 3;
  double lidar_range_m = 17.5;
  double sigma_xy_per_sqrt_m = 0.05;
  double sigma_yaw_per_sqrt_m_rad = 0.001;
  double sigma_yaw_per_rad = 0.005;
  double sigma_z_per_sqrt_m = 0.05;
  RadioChannelParams radio;
  AliasedMatchParams matches;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"cut", "", 0.01, 0.99, "share of the poses that are robot a's"}, self.cut);
    visit(Field{"dimension", "", 2, 3, "2: everything seen from above"}, self.dimension);
    visit(Field{"lidar_range_m", "m", 0.1, 1000, "range of every robot's LiDAR; half of the thesis's 35 m"},
          self.lidar_range_m);
    visit(Field{"sigma_xy_per_sqrt_m", "m/sqrt(m)", 0, 1, "stated noise of x and y; A-LOAM on 00"},
          self.sigma_xy_per_sqrt_m);
    visit(Field{"sigma_yaw_per_sqrt_m_rad", "rad/sqrt(m)", 0, 1, "stated noise of the yaw; A-LOAM on 00"},
          self.sigma_yaw_per_sqrt_m_rad);
    visit(Field{"sigma_yaw_per_rad", "rad/sqrt(rad)", 0, 1, "stated noise of the yaw per turning"},
          self.sigma_yaw_per_rad);
    visit(Field{"sigma_z_per_sqrt_m", "m/sqrt(m)", 0, 1, "stated noise of the height; A-LOAM on 00"},
          self.sigma_z_per_sqrt_m);
    RadioChannelParams::visit_fields(self.radio, visit);
    AliasedMatchParams::visit_fields(self.matches, visit);
  }
};

/// What was recorded: pose for pose the truth and an odometry, each in any frame of its own, x forward, z up.
struct RecordedDrive {
  Trajectory<SE3> truth;
  Trajectory<SE3> odometry;
};

/// Both trajectories have the same stamps, at least four. The common frame is that of the first true pose.
Simulation simulate_kitti(const KittiParams& params, const RecordedDrive& drive, std::uint64_t seed);

}  // namespace radioslam

// KITTI scenario: a recorded drive, cut into two robots that drive at the same time, with simulated radio
// links.
//
// After the test of Wi-Closure (Wang et al.) on KITTI 08 (Geiger et al. 2012): the first part of the sequence
// is robot a, the rest is robot b; both start at time 0, each with its own real odometry in its own start
// frame. Links are simulated from the true poses. The LiDAR's range is half of the 35 m up to which a pair
// counts as overlapping. The stated odometry noise was fitted to A-LOAM on sequence 00 (docs/defaults.md).
//
// With lidar_beams robots scan streets that are made around the drive (roadside.hpp), from the true poses;
// the recording's own scans are not used, and everything else stays the same. The truth of KITTI 08 disagrees
// with itself by up to 6 m in height where the drive passes a place again: one passage then scans the same
// houses from higher up (docs/experiments.md).
#pragma once

#include <cstdint>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/sim/sensors/aliased_matches.hpp"
#include "radioslam/sim/sensors/lidar_scanner.hpp"
#include "radioslam/sim/sensors/radio_channel.hpp"
#include "radioslam/sim/worlds/roadside.hpp"

namespace radioslam {

/// A scanner at the body's origin, as in a recording of LiDAR poses.
inline LidarScannerParams lidar_at_body() {
  LidarScannerParams lidar;
  lidar.lidar_height_m = 0;
  return lidar;
}

/// All parameters of such a mission except the recording. Field names are unique over all parts.
struct KittiParams {
  double cut = 0.34;
  int dimension = 3;
  double lidar_range_m = 17.5;
  double sigma_xy_per_sqrt_m = 0.05;
  double sigma_yaw_per_sqrt_m_rad = 0.001;
  double sigma_yaw_per_rad = 0.005;
  double sigma_z_per_sqrt_m = 0.05;
  LidarScannerParams lidar = lidar_at_body();
  double body_height_m = 1.73;
  RoadsideParams roadside;
  RadioChannelParams radio;
  AliasedMatchParams matches;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(cut, "", 0.01, 0.99, "ratio of the poses that are assigned to robot a");
    RADIOSLAM_BASIC_FIELD(
        dimension, "", 2, 3,
        "dimension of the mission: 2 for poses projected to the plane, 3 for poses in space");
    RADIOSLAM_BASIC_FIELD(lidar_range_m, "m", 0.1, 1000,
                          "range of every robot's LiDAR; half of the 35 m in Wi-Closure (Wang et al.)");
    RADIOSLAM_BASIC_FIELD(sigma_xy_per_sqrt_m, "m/sqrt(m)", 0, 1,
                          "stated white noise of x and y, per axis (default: A-LOAM on sequence 00)");
    RADIOSLAM_FIELD(sigma_yaw_per_sqrt_m_rad, "rad/sqrt(m)", 0, 1,
                    "stated white noise of the yaw per path length (default: A-LOAM on sequence 00)");
    RADIOSLAM_FIELD(sigma_yaw_per_rad, "rad/sqrt(rad)", 0, 1, "stated white noise of the yaw per rotation");
    RADIOSLAM_FIELD(sigma_z_per_sqrt_m, "m/sqrt(m)", 0, 1,
                    "stated white noise of the height (default: A-LOAM on sequence 00)");
    LidarScannerParams::visit_fields(self.lidar, visit);
    RADIOSLAM_FIELD(body_height_m, "m", 0, 100,
                    "height of the body's origin above the ground, if it is scanned; 1.73 for KITTI's LiDAR");
    RoadsideParams::visit_fields(self.roadside, visit);
    RadioChannelParams::visit_fields(self.radio, visit);
    AliasedMatchParams::visit_fields(self.matches, visit);
  }
};

/// A recording: true poses and odometry poses, one for one, each in any frame of their own, x forward, z up.
struct RecordedDrive {
  Trajectory<SE3> truth;
  Trajectory<SE3> odometry;
};

/// Both trajectories have the same stamps, at least four. The common frame is that of the first true pose.
Simulation simulate_kitti(const KittiParams& params, const RecordedDrive& drive, std::uint64_t seed);

}  // namespace radioslam

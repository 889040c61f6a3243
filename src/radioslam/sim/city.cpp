#include "radioslam/sim/city.hpp"

#include <string>
#include <utility>

#include "radioslam/sim/hills.hpp"
#include "radioslam/sim/radio_mission.hpp"
#include "radioslam/sim/surface_odometry.hpp"
#include "radioslam/sim/team_drives.hpp"

namespace radioslam {
namespace {

TeamDriveParams drives_of(const CityParams& params) {
  TeamDriveParams drives;
  drives.robots = params.robots;
  drives.drive = {params.path_length_m, params.speed_mps, params.corner_radius_m, params.sigma_wander_m};
  drives.rate_hz = params.odometry.odometry_rate_hz;
  drives.meeting_range_m = params.radio.radio_range_m;
  drives.least_meeting_s = params.least_meeting_s;
  return drives;
}

/// The odometry turned to where a compass with a constant error says that the robot faced at its start.
Trajectory<SE3> turned(const Trajectory<SE3>& odometry, double heading_rad) {
  const SE3 T_turned_start = lift(SE2(Eigen::Vector2d::Zero(), heading_rad));
  std::vector<StampedPose<SE3>> poses;
  for (const auto& [stamp, pose] : odometry) poses.push_back({stamp, T_turned_start * pose});
  return Trajectory<SE3>(std::move(poses));
}

DrivenRobot drive_robot(Trajectory<SE3> truth, const CityParams& params, const Rng& rng) {
  DrivenRobot robot;
  const double sigma_z = params.dimension == 3 ? params.sigma_z_per_sqrt_m : 0;
  robot.odometry = drift_over_ground(truth, params.odometry, sigma_z, rng);
  robot.noise = stated_noise(params.odometry, params.sigma_z_per_sqrt_m);
  if (params.absolute_heading) {
    const double error_rad = rng.split("compass").normal(0, params.sigma_heading_rad);
    robot.odometry = turned(robot.odometry, truth.front().pose.yaw() + error_rad);
    robot.sigma_heading_rad = params.sigma_heading_rad;
  }
  robot.truth = std::move(truth);
  return robot;
}

}  // namespace

Simulation simulate_city(const CityParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("city");
  const bool hilly = params.dimension == 3;
  const LaneGrid streets = make_streets(params.streets, rng.split("streets"));
  const Hills ground = hilly ? Hills(params.sigma_height_m, rng.split("hills")) : Hills();

  std::vector<DrivenRobot> robots;
  for (auto& truth : drive_team(streets, ground, drives_of(params), rng.split("drives")))
    robots.push_back(drive_robot(std::move(truth), params, rng.split("odometry").split(robots.size())));
  return make_radio_mission(std::move(robots),
                            {"city-" + std::to_string(seed), params.dimension, params.lidar_range_m,
                             params.radio, params.matches, place_alias(2 * params.lidar_range_m)},
                            rng);
}

}  // namespace radioslam

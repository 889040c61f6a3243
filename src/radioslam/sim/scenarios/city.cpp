#include "radioslam/sim/scenarios/city.hpp"

#include <memory>
#include <string>
#include <utility>

#include "radioslam/sim/motion/drive.hpp"
#include "radioslam/sim/scenarios/radio_mission.hpp"
#include "radioslam/sim/sensors/surface_odometry.hpp"
#include "radioslam/sim/worlds/hills.hpp"

namespace radioslam {
namespace {

TeamDriveParams drives_of(const CityParams& params) {
  TeamDriveParams drives;
  drives.robots = params.robots;
  drives.drive = {params.path_length_m, params.speed_mps, params.corner_radius_m, params.sigma_wander_m};
  drives.rate_hz = params.odometry.odometry_rate_hz;
  drives.contact_range_m = params.radio.radio_range_m;
  drives.min_contact_s = params.min_contact_s;
  return drives;
}

/// The odometry rotated to the initial heading given by a compass with a constant error.
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

  OnboardParams onboard = params.onboard;
  onboard.lidar.range_m = params.lidar_range_m;

  std::vector<DrivenRobot> robots;
  std::vector<std::shared_ptr<const TrueMotion>> motions;
  for (auto& trajectory : drive_team(streets, ground, drives_of(params), rng.split("drives"))) {
    auto ridden = make_motion(std::move(trajectory), params.odometry.odometry_rate_hz, onboard,
                              rng.split("rides").split(robots.size()));
    motions.push_back(std::move(ridden.motion));
    robots.push_back(
        drive_robot(std::move(ridden.poses), params, rng.split("odometry").split(robots.size())));
  }
  Simulation simulation =
      make_radio_mission(std::move(robots),
                         {"city-" + std::to_string(seed), params.dimension, params.lidar_range_m,
                          params.radio, params.matches, upright_alias(2 * params.lidar_range_m)},
                         rng);
  WorldShapes shapes;
  shapes.boxes = build_houses(params.streets, params.houses, ground, rng.split("houses"));
  shapes.ground = ground;
  for (std::size_t r = 0; r < motions.size(); ++r)
    simulation.mission.robots[r].fixes = simulate_gnss(*motions[r], params.gnss, rng.split("gnss").split(r));
  add_onboard_sensors(simulation, motions, std::move(shapes), onboard, rng.split("onboard"));
  return simulation;
}

}  // namespace radioslam

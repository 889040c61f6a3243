#include "radioslam/sim/scenarios/kitti.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/sim/scenarios/onboard_sensors.hpp"
#include "radioslam/sim/scenarios/radio_mission.hpp"

namespace radioslam {
namespace {

/// Poses begin .. end - 1, with time starting at 0, left-multiplied by T_frame_original.
Trajectory<SE3> part(const Trajectory<SE3>& whole, std::size_t begin, std::size_t end,
                     const SE3& T_frame_original, int dimension) {
  std::vector<StampedPose<SE3>> poses;
  for (std::size_t k = begin; k < end; ++k) {
    const SE3 pose = T_frame_original * whole[k].pose;
    poses.push_back(
        {{whole[k].stamp.ns - whole[begin].stamp.ns}, dimension == 2 ? lift(flatten(pose)) : pose});
  }
  return Trajectory<SE3>(std::move(poses));
}

OdometryNoise noise_of(const KittiParams& params) {
  OdometryNoise noise;
  noise.sigma_xy_per_sqrt_m = params.sigma_xy_per_sqrt_m;
  noise.sigma_yaw_per_sqrt_m_rad = params.sigma_yaw_per_sqrt_m_rad;
  noise.sigma_yaw_per_rad = params.sigma_yaw_per_rad;
  noise.sigma_z_per_sqrt_m = params.sigma_z_per_sqrt_m;
  return noise;
}

/// The scans of all robots, which together drive through one world.
void add_scans(Simulation& simulation, const KittiParams& params, const Rng& rng) {
  OnboardParams onboard;
  onboard.lidar = params.lidar;
  onboard.lidar.range_m = params.lidar_range_m;
  std::vector<std::shared_ptr<const TrueMotion>> motions;
  std::vector<Eigen::Vector3d> path;
  for (const auto& robot : simulation.truth.robots) {
    motions.push_back(std::make_shared<const TrueMotion>(robot.poses));
    for (const auto& [stamp, pose] : robot.poses)
      path.push_back(pose.translation() - params.body_height_m * Eigen::Vector3d::UnitZ());
  }
  WorldShapes shapes = build_roadside(path, params.roadside, params.lidar_range_m, rng.split("roadside"));
  add_onboard_sensors(simulation, motions, std::move(shapes), onboard, rng.split("onboard"));
}

}  // namespace

Simulation simulate_kitti(const KittiParams& params, const RecordedDrive& drive, std::uint64_t seed) {
  const std::size_t size = drive.truth.size();
  RADIOSLAM_CHECK(size >= 4 && drive.odometry.size() == size,
                  "a drive has one odometry pose per true pose, and at least four");
  const auto wanted = static_cast<std::size_t>(std::lround(params.cut * static_cast<double>(size)));
  const std::size_t cut = std::clamp<std::size_t>(wanted, 2, size - 2);
  const SE3 T_common_file = drive.truth.front().pose.inverse();

  const auto robot = [&](std::size_t begin, std::size_t end) {
    return DrivenRobot{
        part(drive.truth, begin, end, T_common_file, params.dimension),
        part(drive.odometry, begin, end, drive.odometry[begin].pose.inverse(), params.dimension),
        noise_of(params)};
  };
  std::vector<DrivenRobot> robots;
  robots.push_back(robot(0, cut));
  robots.push_back(robot(cut, size));
  const Rng rng = Rng(seed).split("kitti");
  Simulation simulation =
      make_radio_mission(std::move(robots),
                         {"kitti-" + std::to_string(seed), params.dimension, params.lidar_range_m,
                          params.radio, params.matches, upright_alias(2 * params.lidar_range_m)},
                         rng);
  if (params.lidar.lidar_beams > 0) add_scans(simulation, params, rng);
  return simulation;
}

}  // namespace radioslam

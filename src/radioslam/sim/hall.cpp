#include "radioslam/sim/hall.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/sim/hills.hpp"
#include "radioslam/sim/radio_mission.hpp"
#include "radioslam/sim/surface_odometry.hpp"
#include "radioslam/sim/team_drives.hpp"

namespace radioslam {
namespace {

constexpr double kCornerRadius_m = 0.6;
constexpr double kWander_m = 0.1;
/// Places look alike up to so many pillars away along each side.
constexpr int kLargestShift = 2;

int aisles(double size_m, double spacing_m) {
  return std::clamp(static_cast<int>(std::lround(size_m / spacing_m)), 2, 50);
}

LaneGrid aisles_between_pillars(const HallParams& params, Rng rng) {
  LaneGridParams lanes;
  lanes.floor_x_m = params.hall_x_m;
  lanes.floor_y_m = params.hall_y_m;
  lanes.aisles_along_y = aisles(params.hall_x_m, params.pillar_spacing_m);
  lanes.aisles_along_x = aisles(params.hall_y_m, params.pillar_spacing_m);
  lanes.margin_m = std::min(params.pillar_spacing_m / 2, std::min(params.hall_x_m, params.hall_y_m) / 4);
  lanes.closed_lane_share = 0;
  return LaneGrid(lanes, rng);
}

/// A shift by whole pillars, not by none.
DrawAlias pillar_alias(double spacing_m) {
  return [spacing_m](const Trajectory<SE3>&, const Trajectory<SE3>&, Rng& rng) {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    while (shift.isZero(0))
      for (int axis = 0; axis < 2; ++axis)
        shift(axis) = spacing_m * (static_cast<int>(rng.below(2 * kLargestShift + 1)) - kLargestShift);
    return SE3(shift, Eigen::Quaterniond::Identity());
  };
}

}  // namespace

Simulation simulate_hall(const HallParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("hall");
  TeamDriveParams drives;
  drives.robots = params.robots;
  drives.drive = {params.path_length_m, params.speed_mps, kCornerRadius_m, kWander_m};
  drives.rate_hz = params.odometry.odometry_rate_hz;
  const LaneGrid lanes = aisles_between_pillars(params, rng.split("aisles"));

  std::vector<DrivenRobot> robots;
  for (auto& truth : drive_team(lanes, Hills(), drives, rng.split("drives"))) {
    const Rng own = rng.split("odometry").split(robots.size());
    auto odometry = drift_over_ground(truth, params.odometry, 0, own);
    robots.push_back({std::move(truth), std::move(odometry), stated_noise(params.odometry)});
  }
  return make_radio_mission(std::move(robots),
                            {"hall-" + std::to_string(seed), 2, params.lidar_range_m, params.radio,
                             params.matches, pillar_alias(params.pillar_spacing_m)},
                            rng);
}

}  // namespace radioslam

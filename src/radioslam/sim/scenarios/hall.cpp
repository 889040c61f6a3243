#include "radioslam/sim/scenarios/hall.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "radioslam/sim/motion/drive.hpp"
#include "radioslam/sim/scenarios/radio_mission.hpp"
#include "radioslam/sim/sensors/surface_odometry.hpp"
#include "radioslam/sim/worlds/hills.hpp"

namespace radioslam {
namespace {

constexpr double kCornerRadius_m = 0.6;
constexpr double kWander_m = 0.1;
/// Largest alias shift along each side, in pillar spacings.
constexpr int kMaxShift = 2;

int aisles(double size_m, double spacing_m) {
  return std::clamp(static_cast<int>(std::lround(size_m / spacing_m)), 2, 50);
}

LaneGridParams aisles_between_pillars(const HallParams& params) {
  LaneGridParams lanes;
  lanes.floor_x_m = params.hall_x_m;
  lanes.floor_y_m = params.hall_y_m;
  lanes.aisles_along_y = aisles(params.hall_x_m, params.pillar_spacing_m);
  lanes.aisles_along_x = aisles(params.hall_y_m, params.pillar_spacing_m);
  lanes.margin_m = std::min(params.pillar_spacing_m / 2, std::min(params.hall_x_m, params.hall_y_m) / 4);
  lanes.closed_lane_ratio = 0;
  return lanes;
}

/// A non-zero shift by whole pillar spacings.
DrawAlias pillar_alias(double spacing_m) {
  return [spacing_m](const Trajectory<SE3>&, const Trajectory<SE3>&, Rng& rng) {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    while (shift.isZero(0))
      for (int axis = 0; axis < 2; ++axis)
        shift(axis) = spacing_m * (static_cast<int>(rng.below(2 * kMaxShift + 1)) - kMaxShift);
    return SE3(shift, Eigen::Quaterniond::Identity());
  };
}

/// Midway between two adjacent ones of `count` lines from margin to size - margin.
double midway_m(int index, int count, double size_m, double margin_m) {
  return margin_m + (size_m - 2 * margin_m) * (index + 0.5) / (count - 1);
}

}  // namespace

WorldShapes hall_shapes(const HallParams& params) {
  const Eigen::Vector2d size(params.hall_x_m, params.hall_y_m);
  const LaneGridParams lanes = aisles_between_pillars(params);
  WorldShapes shapes;
  shapes.boxes.push_back({size / 2, Eigen::Vector2d::UnitX(), size / 2, 0, params.hall_height_m});
  for (int i = 0; i + 1 < lanes.aisles_along_y; ++i)
    for (int j = 0; j + 1 < lanes.aisles_along_x; ++j) {
      const Eigen::Vector2d place(midway_m(i, lanes.aisles_along_y, size.x(), lanes.margin_m),
                                  midway_m(j, lanes.aisles_along_x, size.y(), lanes.margin_m));
      shapes.pillars.push_back({place, params.pillar_radius_m, 0, params.hall_height_m});
    }
  return shapes;
}

Simulation simulate_hall(const HallParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("hall");
  TeamDriveParams drives;
  drives.robots = params.robots;
  drives.drive = {params.path_length_m, params.speed_mps, kCornerRadius_m, kWander_m};
  drives.rate_hz = params.odometry.odometry_rate_hz;
  const LaneGrid lanes(aisles_between_pillars(params), rng.split("aisles"));
  OnboardParams onboard = params.onboard;
  onboard.lidar.range_m = params.lidar_range_m;

  std::vector<DrivenRobot> robots;
  std::vector<std::shared_ptr<const TrueMotion>> motions;
  for (auto& trajectory : drive_team(lanes, Hills(), drives, rng.split("drives"))) {
    auto ridden =
        make_motion(std::move(trajectory), drives.rate_hz, onboard, rng.split("rides").split(robots.size()));
    const Rng own = rng.split("odometry").split(robots.size());
    auto odometry = drift_over_ground(ridden.poses, params.odometry, 0, own);
    motions.push_back(std::move(ridden.motion));
    robots.push_back({std::move(ridden.poses), std::move(odometry), stated_noise(params.odometry)});
  }
  Simulation simulation =
      make_radio_mission(std::move(robots),
                         {"hall-" + std::to_string(seed), 2, params.lidar_range_m, params.radio,
                          params.matches, pillar_alias(params.pillar_spacing_m)},
                         rng);
  add_onboard_sensors(simulation, motions, hall_shapes(params), onboard, rng.split("onboard"));
  return simulation;
}

}  // namespace radioslam

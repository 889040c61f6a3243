#include "radioslam/sim/scenarios/corridors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/sim/motion/drive.hpp"
#include "radioslam/sim/motion/stamps.hpp"
#include "radioslam/sim/scenarios/radio_mission.hpp"
#include "radioslam/sim/sensors/surface_odometry.hpp"

namespace radioslam {
namespace {

constexpr double kTurnRadius_m = 1.2;
constexpr double kFreeHalfWidth_m =
    1.4;  ///< width to either side of the paths through a room that is kept free
constexpr double kThinnestThing_m = 0.15, kThickestThing_m = 0.6, kLowestCrate_m = 0.4;
constexpr std::size_t kRooms = 4;
constexpr double kTripMargin = 2;  ///< corners shorten the path, by less than half

/// The centres of the rooms, counter-clockwise.
std::array<Eigen::Vector2d, kRooms> room_centres(const CorridorsParams& params) {
  const double x = params.corridor_m + params.room_m, y = params.cross_corridor_m + params.room_m;
  return {Eigen::Vector2d(0, 0), Eigen::Vector2d(x, 0), Eigen::Vector2d(x, y), Eigen::Vector2d(0, y)};
}

/// Walls in the frame of a room whose corridors continue along its x and y axes.
class RoomFrame {
 public:
  RoomFrame(const SE2& T_common_room, const CorridorsParams& params, WorldShapes& shapes)
      : T_common_room_(T_common_room), params_(params), shapes_(shapes) {}

  /// Two closed sides, and two with a corridor's opening.
  void build_walls() {
    const double half = 0.5 * params_.room_m, mouth = 0.5 * params_.corridor_width_m;
    wall({-half, -half}, {half, -half});
    wall({-half, -half}, {-half, half});
    for (const double side : {-1.0, 1.0}) {
      wall({half, side * mouth}, {half, side * half});
      wall({side * mouth, half}, {side * half, half});
    }
  }

  /// The corridor along x.
  void build_corridor(double length_m) {
    const double begin = 0.5 * params_.room_m, mouth = 0.5 * params_.corridor_width_m;
    for (const double side : {-1.0, 1.0}) wall({begin, side * mouth}, {begin + length_m, side * mouth});
  }

  /// Objects in the room's four corners, alternately crates and pillars.
  void furnish(Rng rng) {
    const double max_m = 0.5 * params_.room_m - kFreeHalfWidth_m;
    for (int k = 0; k < params_.things_per_room; ++k) {
      const Eigen::Vector2d corner(k % 4 < 2 ? 1 : -1, k % 2 == 0 ? 1 : -1);
      const double reach_m = rng.uniform(kThinnestThing_m, std::min(kThickestThing_m, 0.5 * max_m));
      const double x = rng.uniform(reach_m, max_m - reach_m), y = rng.uniform(reach_m, max_m - reach_m);
      const Eigen::Vector2d place =
          corner.cwiseProduct(Eigen::Vector2d(kFreeHalfWidth_m + x, kFreeHalfWidth_m + y));
      if (k / 4 % 2 == 0)
        add_crate(place, reach_m, rng);
      else
        shapes_.pillars.push_back({T_common_room_ * place, reach_m, 0, params_.ceiling_m});
    }
  }

 private:
  void wall(const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
    shapes_.boxes.push_back(wall_between(T_common_room_ * begin, T_common_room_ * end, 0, params_.ceiling_m));
  }

  /// A crate whose corners are `reach_m` from its centre.
  void add_crate(const Eigen::Vector2d& place, double reach_m, Rng& rng) {
    const double heading = rng.uniform(0, std::numbers::pi), diagonal = rng.uniform(0.5, 1.0);
    const double height_m = rng.uniform(kLowestCrate_m, std::max(kLowestCrate_m, params_.ceiling_m));
    shapes_.boxes.push_back({T_common_room_ * place,
                             {std::cos(heading), std::sin(heading)},
                             reach_m * Eigen::Vector2d(std::cos(diagonal), std::sin(diagonal)),
                             0,
                             height_m});
  }

  SE2 T_common_room_;
  const CorridorsParams& params_;
  WorldShapes& shapes_;
};

/// A path around the building, from room centre to room centre.
Trajectory<SE3> round_trip(std::size_t robot, const CorridorsParams& params, const Rng& rng) {
  const auto centres = room_centres(params);
  const std::size_t first = 2 * robot + robot / 2;  // opposite rooms, then the two others
  std::vector<Eigen::Vector2d> corners{centres[first % kRooms]};
  for (double path_m = 0; path_m < kTripMargin * params.path_length_m + params.room_m;) {
    corners.push_back(centres[(first + corners.size()) % kRooms]);
    path_m += (corners.back() - corners[corners.size() - 2]).norm();
  }
  const Drive drive(corners, {params.path_length_m, params.speed_mps, kTurnRadius_m, params.sigma_wander_m},
                    rng);
  const auto stamps =
      regular_stamps(0, params.path_length_m / params.speed_mps, params.odometry.odometry_rate_hz);
  std::vector<SE2> poses;
  for (const Stamp stamp : stamps) poses.push_back(drive.pose_at(params.speed_mps * stamp.seconds()));
  return lifted(stamps, poses);
}

DrivenRobot wheeled_robot(Trajectory<SE3> truth, const CorridorsParams& params, const Rng& rng) {
  DrivenRobot robot;
  if (params.wheel_odometry || params.onboard.lidar.lidar_beams == 0)
    robot.odometry = drift_over_ground(truth, params.odometry, params.sigma_z_per_sqrt_m, rng);
  robot.noise = stated_noise(params.odometry, params.sigma_z_per_sqrt_m);
  robot.truth = std::move(truth);
  return robot;
}

}  // namespace

WorldShapes corridor_shapes(const CorridorsParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("corridors").split("furniture");
  WorldShapes shapes;
  shapes.ceiling_m = params.ceiling_m;
  const auto centres = room_centres(params);
  for (std::size_t room = 0; room < kRooms; ++room) {
    const double quarter_turns = static_cast<double>(room);
    RoomFrame frame(SE2(centres[room], quarter_turns * std::numbers::pi / 2), params, shapes);
    frame.build_walls();
    frame.build_corridor(room % 2 == 0 ? params.corridor_m : params.cross_corridor_m);
    frame.furnish(rng.split(room));
  }
  return shapes;
}

Simulation simulate_corridors(const CorridorsParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("corridors");
  OnboardParams onboard = params.onboard;
  onboard.lidar.range_m = params.lidar_range_m;
  std::vector<DrivenRobot> robots;
  std::vector<std::shared_ptr<const TrueMotion>> motions;
  for (std::size_t r = 0; r < static_cast<std::size_t>(params.robots); ++r) {
    auto ridden = make_motion(round_trip(r, params, rng.split("drives").split(r)),
                              params.odometry.odometry_rate_hz, onboard, rng.split("rides").split(r));
    motions.push_back(std::move(ridden.motion));
    robots.push_back(wheeled_robot(std::move(ridden.poses), params, rng.split("odometry").split(r)));
  }
  Simulation simulation = make_radio_mission(
      std::move(robots), {"corridors-" + std::to_string(seed), 3, params.lidar_range_m, params.radio, {}, {}},
      rng);
  add_onboard_sensors(simulation, motions, corridor_shapes(params, seed), onboard, rng.split("onboard"));
  return simulation;
}

}  // namespace radioslam

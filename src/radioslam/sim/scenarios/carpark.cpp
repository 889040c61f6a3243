#include "radioslam/sim/scenarios/carpark.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {
namespace {

/// A starting crossing for each robot, distinct as long as there are enough.
std::vector<std::size_t> draw_starts(const LaneGrid& lanes, std::size_t robots, const Rng& rng) {
  std::vector<std::size_t> starts;
  std::vector<std::size_t> left;
  for (std::size_t r = 0; r < robots; ++r) {
    if (left.empty())
      for (std::size_t i = 0; i < lanes.size(); ++i) left.push_back(i);
    Rng own = rng.split(r);
    const auto chosen = left.begin() + static_cast<std::ptrdiff_t>(own.below(left.size()));
    starts.push_back(*chosen);
    left.erase(chosen);
  }
  return starts;
}

Drive draw_drive(const LaneGrid& lanes, std::size_t start, const DriveParams& params, const Rng& rng) {
  return Drive(draw_corners(lanes, start, params.path_length_m, rng.split("route")), params,
               rng.split("wander"));
}

std::vector<SE2> poses_at(const std::vector<Stamp>& stamps, const PoseAtTime& pose_at) {
  std::vector<SE2> poses;
  for (const Stamp stamp : stamps) poses.push_back(pose_at(stamp.seconds()));
  return poses;
}

/// One robot's recordings and truth.
struct RobotRun {
  Robot robot;
  RobotTruth truth;
};

RobotRun run_robot(const std::string& id, const CarparkWorld& world, std::size_t start,
                   const CarparkParams& params, const Rng& rng) {
  const Drive drive = draw_drive(world.lanes, start, params.drive, rng);
  const PoseAtTime pose_at = [&](double t_s) { return drive.pose_at(params.drive.speed_mps * t_s); };
  const double drive_s = params.drive.path_length_m / params.drive.speed_mps;
  const auto odometry_stamps = regular_stamps(0, drive_s, params.odometry.odometry_rate_hz);
  const double end_s = odometry_stamps.back().seconds();
  const auto truth_stamps = regular_stamps(0, end_s, params.truth_rate_hz);
  const auto true_poses = poses_at(odometry_stamps, pose_at);

  RobotRun run;
  run.robot.id = id;
  run.robot.odometry = lifted(
      odometry_stamps, draw_dead_reckoning(true_poses, params.odometry, rng.split("odometry")).T_start_body);
  run.robot.odometry_noise = stated_noise(params.odometry);
  if (params.known_start) run.robot.initial_pose = lift(true_poses.front());
  run.robot.wifi = simulate_scans(pose_at, 0, end_s, world.transmitters, params.transmitters.phone_height_m,
                                  params.phones, rng.split("phones"));
  run.truth = {id, lifted(truth_stamps, poses_at(truth_stamps, pose_at)), true};
  return run;
}

}  // namespace

CarparkWorld make_carpark_world(const CarparkParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("carpark");
  return {LaneGrid(params.lanes, rng.split("lanes")),
          place_transmitters(params.lanes, params.transmitters, rng.split("transmitters"))};
}

Simulation simulate_carpark(const CarparkParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("carpark");
  const CarparkWorld world = make_carpark_world(params, seed);
  const auto robots = static_cast<std::size_t>(params.robots);
  const auto starts = draw_starts(world.lanes, robots, rng.split("starts"));

  Simulation simulation;
  simulation.mission.name = "carpark-" + std::to_string(seed);
  constexpr double kSigmaSurvey_m = 0.5;
  for (const auto& radio : world.transmitters) {
    simulation.mission.access_points.push_back(radio.bssid());
    if (simulation.mission.anchors.size() < static_cast<std::size_t>(params.known_access_points))
      simulation.mission.anchors.push_back({radio.bssid(), radio.position(), kSigmaSurvey_m});
  }
  std::vector<RobotRun> runs(robots);
  parallel_for(robots, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      runs[r] = run_robot(robot_id(r), world, starts[r], params, rng.split("robots").split(r));
  });
  for (auto& [robot, truth] : runs) {
    simulation.mission.robots.push_back(std::move(robot));
    simulation.truth.robots.push_back(std::move(truth));
  }
  return simulation;
}

}  // namespace radioslam

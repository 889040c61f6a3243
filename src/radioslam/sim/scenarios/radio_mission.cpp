#include "radioslam/sim/scenarios/radio_mission.hpp"

#include <utility>

#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {

Simulation make_radio_mission(std::vector<DrivenRobot> robots, const RadioMissionParams& params,
                              const Rng& rng) {
  std::vector<Trajectory<SE3>> truth;
  for (const DrivenRobot& robot : robots) truth.push_back(robot.truth);
  RadioLinks links = simulate_links(truth, params.dimension, params.radio, rng.split("radio"));
  LabelledMatches matches = simulate_matches(truth, params.dimension, 2 * params.lidar_range_m,
                                             params.draw_alias, params.matches, rng.split("matches"));

  Simulation simulation;
  Mission& mission = simulation.mission;
  mission.name = params.name;
  mission.dimension = params.dimension;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    Robot& robot = mission.robots.emplace_back();
    robot.id = robot_id(r);
    robot.odometry = std::move(robots[r].odometry);
    robot.odometry_noise = robots[r].noise;
    if (robots[r].sigma_heading_rad) {
      robot.heading = Heading::kAbsolute;
      robot.sigma_heading_rad = *robots[r].sigma_heading_rad;
    }
    robot.lidar_range_m = params.lidar_range_m;
    simulation.truth.robots.push_back({robot.id, std::move(robots[r].truth), true});
  }
  mission.ranges = std::move(links.ranges);
  mission.aoa_measurements = std::move(links.aoa_measurements);
  mission.matches = std::move(matches.matches);
  simulation.truth.direct_paths = std::move(links.direct_paths);
  simulation.truth.true_matches = std::move(matches.true_matches);
  return simulation;
}

}  // namespace radioslam

#include "radioslam/eval/team_estimate.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool is_elsewhere(const std::string& id, const std::vector<Component>& components) {
  return !components.empty() && !contains(components.front().robots, id);
}

std::vector<EstimatedTrajectory> in_common_frame(std::vector<EstimatedTrajectory> robots,
                                                 const std::vector<Component>& components,
                                                 const std::vector<std::string>& unplaced) {
  for (auto& robot : robots)
    if (is_elsewhere(robot.id, components) || contains(unplaced, robot.id)) robot = {robot.id, {}};
  return robots;
}

std::vector<EstimatedTrajectory> team_estimate(const std::vector<RobotResult>& robots,
                                               const RunResult& result) {
  std::vector<EstimatedTrajectory> team;
  for (const auto& robot : robots) {
    team.push_back(
        {robot.id, robot.estimate, robot.sigma_position_m, robot.sigma_team_m, {}, robot.sigma_rad});
    for (const UntiedStretch& stretch : robot.untied)
      team.back().untied.emplace_back(stretch.first, stretch.last);
  }
  return in_common_frame(std::move(team), result.components, result.unplaced);
}

std::vector<EstimatedTrajectory> team_estimate(const RunResult& result) {
  return team_estimate(result.robots, result);
}

}  // namespace radioslam

// The part of a robot's graph that it optimises while others' poses rest.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/distributed/robot_graph.hpp"

namespace radioslam {

/// The factors within the robot, then those between it and others that are `usable` (places in
/// robot.graph.relative_poses), with the copies of others' poses fixed.
template <class Pose>
PoseGraph<Pose> active_graph(const RobotGraph<Pose>& robot, const std::vector<std::uint32_t>& usable) {
  PoseGraph<Pose> active = robot.graph;
  active.relative_poses.resize(robot.own_relative_poses);
  for (const std::uint32_t k : usable) active.relative_poses.push_back(robot.graph.relative_poses[k]);
  active.pose_fixed.assign(active.poses.size(), false);
  for (std::size_t p = robot.own_poses; p < active.poses.size(); ++p) active.pose_fixed[p] = true;
  return active;
}

}  // namespace radioslam

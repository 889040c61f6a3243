// The part of a robot's graph that it optimises while others' poses rest, and its factorisation.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/distributed/robot_graph.hpp"
#include "radioslam/graph/normal_equations.hpp"

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

/// Factorises with as little damping as it takes; false where none helps, because of numbers beyond measure.
template <class Pose>
bool factorize_damped(NormalEquations<Pose>& equations) {
  constexpr double kFirst = 1e-8, kLast = 1e8;
  if (equations.factorize(0) == Factorization::kDone) return true;
  for (double damping = kFirst; damping <= kLast; damping *= 10)
    if (equations.factorize(damping) == Factorization::kDone) return true;
  return false;
}

}  // namespace radioslam

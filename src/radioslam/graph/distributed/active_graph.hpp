// The part of a robot's graph that it optimises while others' poses rest, and its steps.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
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

/// The step of the own poses by a quadratic that bounds the linearised cost from above, whatever neighbours
/// do at the same time: in its information factors with others count double, in its gradient once (Fan and
/// Murphey 2021).
struct MajorizedStep {
  double cost = 0;           ///< at the graph's poses
  Eigen::VectorXd gradient;  ///< of the cost
  /// Nothing where a neighbour has sent poses beyond all measure: then until others come.
  std::optional<Eigen::VectorXd> step;
};

/// `active`: active_graph(robot, usable) at the poses to start from; `equations` are of it.
template <class Pose>
MajorizedStep majorized_step(const RobotGraph<Pose>& robot, const std::vector<std::uint32_t>& usable,
                             PoseGraph<Pose>& active, NormalEquations<Pose>& equations) {
  const auto weigh_between = [&](double factor) {
    for (std::size_t k = 0; k < usable.size(); ++k)
      active.relative_poses[robot.own_relative_poses + k].weight =
          factor * robot.graph.relative_poses[usable[k]].weight;
  };
  MajorizedStep result;
  result.cost = equations.linearise(active);
  result.gradient = equations.gradient();
  weigh_between(2);
  equations.linearise(active);
  weigh_between(1);
  if (!std::isfinite(result.cost) || !factorize_damped(equations)) return result;
  Eigen::VectorXd step = equations.cholesky().solve(-result.gradient);
  if (step.allFinite()) result.step = std::move(step);
  return result;
}

}  // namespace radioslam

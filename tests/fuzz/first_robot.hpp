// A robot that shares factors with another one, and the solvers that hear messages for it.
#pragma once

#include <memory>
#include <vector>

#include "radioslam/graph/distributed/alternating.hpp"
#include "radioslam/graph/distributed/block_coordinate.hpp"
#include "radioslam/graph/distributed/separators.hpp"
#include "radioslam/graph/distributed/two_stage.hpp"

namespace radioslam {

/// Two robots of three poses each, with a factor between every pair.
template <class Pose>
RobotGraph<Pose> first_robot() {
  PoseGraph<Pose> graph;
  graph.poses.resize(6);
  const auto measure = [&](std::size_t i, std::size_t j) {
    auto& factor = graph.relative_poses.emplace_back();
    factor.i = PoseId(i);
    factor.j = PoseId(j);
    factor.T_i_j = Pose::exp(Pose::Tangent::Unit(0));
  };
  for (const std::size_t i : {0U, 1U, 3U, 4U}) measure(i, i + 1);
  for (const std::size_t i : {0U, 1U, 2U}) measure(i, i + 3);
  return split_by_robot(graph, team_poses({0, 0, 0, 1, 1, 1}, 2))[0];
}

template <class Pose>
std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers_of_first_robot() {
  static const RobotGraph<Pose> robot = first_robot<Pose>();
  SeparatorsParams repeating;
  repeating.repeat_after = 1;
  repeating.outliers.gate = 28;
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers;
  solvers.push_back(std::make_unique<SeparatorsSolver<Pose>>(robot, SeparatorsParams{}));
  solvers.push_back(std::make_unique<SeparatorsSolver<Pose>>(robot, repeating));
  solvers.push_back(std::make_unique<BlockCoordinateSolver<Pose>>(robot, BlockCoordinateParams{}));
  solvers.push_back(std::make_unique<TwoStageSolver<Pose>>(robot, TwoStageParams{}));
  solvers.push_back(std::make_unique<AlternatingSolver<Pose>>(robot, AlternatingParams{}));
  return solvers;
}

}  // namespace radioslam

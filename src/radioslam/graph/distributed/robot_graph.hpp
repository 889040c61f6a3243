// What one robot of a team holds of the team's pose graph: its own poses, every factor that is about one of
// them, and a copy of the neighbours' poses in factors between robots. Nobody holds more.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// A robot's number in its team.
using RobotNumber = std::uint32_t;

/// A pose of the team: the robot it belongs to and its number along that robot's trajectory.
struct PoseKey {
  RobotNumber robot = 0;
  std::uint32_t pose = 0;
  auto operator<=>(const PoseKey&) const = default;
};

/// A robot that this one shares factors with. Both robots know these factors, and so list the poses alike:
/// the poses one sends are those the other expects, in ascending order.
struct NeighbourRobot {
  RobotNumber robot = 0;
  std::vector<std::uint32_t> seen;     ///< own poses in factors with it, ascending
  std::vector<std::uint32_t> copies;   ///< places in graph.poses of its poses, by ascending number there
  std::vector<std::uint32_t> between;  ///< places in graph.relative_poses of the factors with it, ascending
};

template <class Pose>
struct RobotGraph {
  RobotNumber robot = 0;
  std::size_t own_poses = 0;
  /// Own poses first, in their order along the trajectory, then the copies. Among the relative poses those
  /// within the robot come first, then those between it and others.
  PoseGraph<Pose> graph;
  std::size_t own_relative_poses = 0;
  std::vector<PoseKey> copies;             ///< of graph.poses beyond own_poses
  std::vector<NeighbourRobot> neighbours;  ///< by ascending number
  /// Per own pose: its connected component within the robot, from 0; those that others see come first.
  std::vector<std::uint32_t> part_of;
  std::size_t parts = 0;

  /// The values of the own poses.
  std::vector<Pose> trajectory() const {
    return {graph.poses.begin(), graph.poses.begin() + static_cast<std::ptrdiff_t>(own_poses)};
  }
  std::size_t copy_of(std::size_t pose) const { return pose - own_poses; }
  bool is_own(PoseId pose) const { return pose.index() < own_poses; }
};

/// Index into RobotGraph::neighbours, or their number if there is none.
template <class Pose>
std::size_t neighbour_index(const RobotGraph<Pose>& robot, RobotNumber number);

/// The factors within the robot alone, over its own poses.
template <class Pose>
PoseGraph<Pose> own_graph(const RobotGraph<Pose>& robot);

/// Whose pose is which, for a team in one graph.
struct TeamPoses {
  std::vector<RobotNumber> robot_of;            ///< per pose of the team's graph
  std::vector<std::vector<std::size_t>> poses;  ///< per robot, its poses in order
};
TeamPoses team_poses(const std::vector<RobotNumber>& robot_of_pose, std::size_t robots);

/// Cuts a team's graph: a factor about two robots goes to both. Only relative poses may be about two robots,
/// and nothing about points, drifts and biases; aborts otherwise.
template <class Pose>
std::vector<RobotGraph<Pose>> split_by_robot(const PoseGraph<Pose>& graph, const TeamPoses& team);

}  // namespace radioslam

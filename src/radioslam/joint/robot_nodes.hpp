// Node selection: the stamps of a robot's odometry that become poses of the joint graph, which are its
// keyframes and the stamps of radio links, where the odometry is interpolated.
#pragma once

#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct RobotNodes {
  Trajectory<SE3> odometry;            ///< the recorded samples, and one per node in between
  std::vector<std::size_t> rows;       ///< of the nodes, increasing
  std::vector<Stamp> stamps;           ///< of the nodes
  std::vector<std::size_t> keyframes;  ///< indices of the nodes that are keyframes

  /// The node at exactly this stamp, which must exist.
  std::size_t node_at(Stamp stamp) const;
};

/// Nodes at these stamps, which the odometry covers; none is a keyframe.
RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> stamps);

/// Nodes at the robot's keyframes and at `node_stamps`; those that the odometry does not cover are ignored.
RobotNodes select_nodes(const Trajectory<SE3>& odometry, std::vector<Stamp> node_stamps,
                        const KeyframeParams& params);

// Gravity along a trajectory in space. Odometry states no noise of roll and pitch: they come from gravity and
// do not drift. Their error is a Gauss-Markov process of standard deviation sigma_level: the random walk of
// the edges, of variance q between two priors, and priors of information q / (P (P + q)), P = sigma_level^2,
// which keep its variance at P. Without them the walk would lift the end of a kilometre by a hundred metres.

/// Adds the priors of one robot's trajectory: of its first pose unless the start is known, and of later ones
/// unless the noise of the odometry was measured step by step, roll and pitch included. None in the plane.
void add_level_priors(PoseGraph<SE2>& graph, const Robot& robot, const RobotNodes& nodes,
                      std::size_t first_pose, double sigma_level_rad);
void add_level_priors(PoseGraph<SE3>& graph, const Robot& robot, const RobotNodes& nodes,
                      std::size_t first_pose, double sigma_level_rad);

}  // namespace radioslam

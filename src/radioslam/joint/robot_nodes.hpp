// Node selection: the stamps of a robot's odometry that become poses of the joint graph, which are its
// keyframes and the stamps of radio links, where the odometry is interpolated.
#pragma once

#include <vector>

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

}  // namespace radioslam

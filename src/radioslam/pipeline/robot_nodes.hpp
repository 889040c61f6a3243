// The moments of a robot's odometry that become poses of the joint graph: its keyframes, and whenever a radio
// link was measured, where the odometry is interpolated.
#pragma once

#include <vector>

#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct RobotNodes {
  Trajectory<SE3> odometry;            ///< the recorded rows, and one per moment in between
  std::vector<std::size_t> rows;       ///< of the nodes, increasing
  std::vector<Stamp> stamps;           ///< of the nodes
  std::vector<std::size_t> keyframes;  ///< which nodes are keyframes

  /// The node at exactly this stamp; there must be one.
  std::size_t node_at(Stamp stamp) const;
};

/// `moments` that the odometry does not cover are left out.
RobotNodes select_nodes(const Trajectory<SE3>& odometry, std::vector<Stamp> moments,
                        const KeyframeParams& params);

}  // namespace radioslam

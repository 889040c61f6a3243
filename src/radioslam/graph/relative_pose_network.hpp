// The relative poses of a graph as a network, with its breadth-first trees from fixed poses.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// The relative-pose factors at every pose, in the order of the graph.
struct RelativePoseNetwork {
  std::vector<std::size_t> starts;   ///< poses + 1
  std::vector<std::size_t> factors;  ///< of pose p: [starts[p], starts[p + 1])
};
template <class Pose>
RelativePoseNetwork relative_pose_network(const PoseGraph<Pose>& graph);

/// A pose reached from a neighbour, `from`, through a factor; roots have themselves as neighbour.
struct TreeStep {
  std::size_t pose, from, factor;
};

/// Every pose once, neighbours before those they reach: breadth-first from all fixed poses of a component at
/// once, else from its first pose.
template <class Pose>
std::vector<TreeStep> breadth_first_tree(const PoseGraph<Pose>& graph);

}  // namespace radioslam

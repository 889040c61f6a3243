// Chordal initialisation of a graph's poses from its relative measurements alone.
// Source: Carlone, Tron, Daniilidis, Dellaert 2015, Initialization techniques for 3D SLAM; Martinec and
// Pajdla 2007.
//   1. rotations: min over matrices of sum kappa |R_j - R_i R_ij|_F^2, a linear problem, row by row, then
//      each matrix to the nearest rotation;
//   2. translations: min of sum |R_ij^T (R_i^T (t_j - t_i) - t_ij)|^2 in the information of the translation
//      part, a linear problem given the rotations.
// kappa is the mean of the rotation's information; losses are left out, weights are not.
// Cost: two sparse factorisations of d x d blocks on one structure.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

// The relative poses of a graph as a network, with its breadth-first trees from fixed poses.

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

enum class ChordalResult {
  kDone,
  kNotPositiveDefinite,  ///< weights of zero cut a component, or an information is indefinite; poses
                         ///< unchanged
};

/// Sets graph.poses. Fixed poses and the first pose of a component without one keep their values, as do
/// poses without relative measurements. Points and drifts are left as they are.
template <class Pose>
ChordalResult initialise_chordal(PoseGraph<Pose>& graph);

}  // namespace radioslam

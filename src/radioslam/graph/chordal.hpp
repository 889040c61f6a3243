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

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

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

// A team graph without the poses that nothing but their own odometry touches: the odometry between two kept
// poses becomes one relative pose, with the covariance and the drift Jacobian of the composition.
// Composition of increments Z with covariance S and drift Jacobian D, perturbations on the right:
//   (S, D) <- (Ad(Z^-1) S Ad(Z^-1)^T + S_k, Ad(Z^-1) D + D_k).
#pragma once

#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

template <class Pose>
struct CompressedTeam {
  TeamGraph<Pose> team;           ///< points, drifts and their order as in the full graph
  std::vector<PoseId> full_pose;  ///< per compressed pose, its pose in the full graph
};

/// Keeps every piece's first pose and those tied by anything but the odometry of their piece.
template <class Pose>
CompressedTeam<Pose> compress(const TeamGraph<Pose>& full);

/// Puts the compressed graph's values into the full one; poses in between follow the kept pose before them
/// by their own odometry.
template <class Pose>
void expand_values(const CompressedTeam<Pose>& compressed, TeamGraph<Pose>& full);

}  // namespace radioslam

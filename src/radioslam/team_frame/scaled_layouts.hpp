// Layouts of rigid trajectories by classical multidimensional scaling (Torgerson 1952): points of the plane
// from their mutual distances, and from their mirror image. Trajectories rotate but do not flip, which
// distinguishes a layout from its mirror image.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/team_frame/layout_evidence.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

/// 2 x n coordinates whose distances approximate the symmetric n x n `distances_m`, centred at the origin.
/// Rotation and handedness are arbitrary but deterministic.
Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m);

/// Bodies placed, and what their places cost.
struct Layout {
  std::vector<RigidBody> bodies;
  double cost = 0;  ///< layout_cost of rigid_layout.hpp
};

/// Fitted to the evidence from the scaling of its distances and from the mirror image.
std::vector<Layout> scaled_layouts(const LayoutEvidence& evidence, const std::vector<RigidBody>& bodies,
                                   const LayoutParams& params);

}  // namespace radioslam

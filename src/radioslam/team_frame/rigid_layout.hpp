// The stress of a layout of rigid bodies, and its majorisation body by body.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// A rigid set of points with an unknown place.
struct RigidBody {
  std::size_t first_node = 0;    ///< its points are the nodes [first_node, first_node + points.cols())
  Eigen::Matrix2Xd points;       ///< in its own frame
  SE2 T_layout_body;             ///< estimated
  bool fixed = false;            ///< its place is known
  double sigma_heading_rad = 0;  ///< > 0: its rotation is the common one up to this error
};

/// Wanted distances between nodes of different bodies.
struct PairTargets {
  Eigen::MatrixXf distance_m;                                       ///< nodes x nodes
  Eigen::MatrixXf weight;                                           ///< 1/m^2; 0 for no evidence
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> lower_bound;  ///< only pushes apart
};

/// The layout positions of all nodes, 2 x n.
Eigen::Matrix2Xd node_positions(const std::vector<RigidBody>& bodies);

/// Sum of w (|x_i - x_j| - d)^2 over pairs of different bodies, each pair once.
double layout_stress(const std::vector<RigidBody>& bodies, const PairTargets& targets);

/// Up to `sweeps` passes over the free bodies, each moved to the minimum of the stress's majoriser; stops
/// when a pass moves no body by a centimetre. Without heading priors no pass raises the stress.
void majorise_stress(std::vector<RigidBody>& bodies, const PairTargets& targets, int sweeps);

}  // namespace radioslam

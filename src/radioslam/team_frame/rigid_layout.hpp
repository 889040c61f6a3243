// Stress of a layout of rigid bodies, and its majorisation body by body (SMACOF).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// Rigid set of points with an unknown pose.
struct RigidBody {
  std::size_t first_node = 0;    ///< its points are the nodes [first_node, first_node + points.cols())
  Eigen::Matrix2Xd points;       ///< in the body's frame
  SE2 T_layout_body;             ///< estimated
  bool fixed = false;            ///< its pose is known
  double sigma_heading_rad = 0;  ///< > 0: error of its heading in the common frame
};

/// Target distances between nodes of different bodies.
struct PairTargets {
  Eigen::MatrixXf distance_m;                                       ///< nodes x nodes
  Eigen::MatrixXf weight;                                           ///< 1/m^2; 0 for no evidence
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> lower_bound;  ///< only repels
};

/// Positions of all nodes in the layout, 2 x n.
Eigen::Matrix2Xd node_positions(const std::vector<RigidBody>& bodies);

/// Sum of w (|x_i - x_j| - d)^2 over pairs of different bodies, each pair once.
double layout_stress(const std::vector<RigidBody>& bodies, const PairTargets& targets);

/// Moves each free body to the minimum of the stress's majoriser, in up to `sweeps` passes; stops when a pass
/// moves no point by a centimetre. Without heading priors no pass raises the stress.
void majorise_stress(std::vector<RigidBody>& bodies, const PairTargets& targets, int sweeps);

}  // namespace radioslam

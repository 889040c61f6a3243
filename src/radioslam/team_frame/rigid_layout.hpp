// Robust fit of rigid bodies to distances between their points: majorisation of the stress body by body
// (SMACOF, de Leeuw 1977), with Cauchy weights.
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
  Eigen::MatrixXf distance_m;   ///< nodes x nodes
  Eigen::MatrixXf information;  ///< 1/m^2; 0 for no evidence
  Eigen::MatrixXf weight;       ///< below 1: pairs share their errors
};

/// Positions of all nodes in the layout, 2 x n.
Eigen::Matrix2Xd node_positions(const std::vector<RigidBody>& bodies);

/// Sum of w ln(1 + (|x_i - x_j| - d)^2 / sigma^2) / 2 over pairs of different bodies, each pair once, and of
/// (1 - cos(heading - common heading)) / sigma_heading^2.
double layout_cost(const std::vector<RigidBody>& bodies, const PairTargets& targets);

/// Moves the free bodies to a minimum of the cost: majorisation of the stress, its weights renewed every few
/// passes. Returns the cost, which hardly falls any more or has been lowered `rounds` times.
double fit_layout(std::vector<RigidBody>& bodies, const PairTargets& targets, int rounds);

/// Moves each free body to the minimum of the majoriser of sum w / sigma^2 (|x_i - x_j| - d)^2, in up to
/// `sweeps` passes; stops when a pass moves no point by a centimetre. Without heading priors no pass raises
/// this stress.
void majorise_stress(std::vector<RigidBody>& bodies, const PairTargets& targets, int sweeps);

}  // namespace radioslam

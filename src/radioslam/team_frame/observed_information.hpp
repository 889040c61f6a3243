// Observed information of mixture measurements, for covariances: the posterior weights of a mixture overstate
// the information, since which term is true remains uncertain. For one measurement with posterior w and
// squared norm s (Louis 1982, one dominant term) the weight becomes w (1 - (1 - w) s) instead of w.
#pragma once

#include <cstddef>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Lowers the weights of the first `ranges` ranges and of all bearings accordingly, never below zero.
/// Bearings are also discounted for the angular error that `sigma_antenna_position_m` causes at the current
/// distance. For covariances only: the estimate itself is optimal for the original weights.
template <class Pose>
void use_observed_information(PoseGraph<Pose>& graph, std::size_t ranges, double sigma_antenna_position_m);

}  // namespace radioslam

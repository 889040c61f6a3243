// What measurements of uncertain origin really say: the expected weights of a mixture overstate it, since
// which term is right is not known. Observed information of one measurement with posterior w and squared norm
// s (Louis 1982, one dominant term): w (1 - (1 - w) s) instead of w.
#pragma once

#include <cstddef>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Lowers the weights of the first `ranges` ranges and of all bearings accordingly, never below zero; those
/// of bearings also by what the antennas' places, known to `sigma_place_m`, do to an angle at the present
/// distance. For covariances only: the estimate itself belongs to the weights as they were.
template <class Pose>
void discount_uncertain_measurements(PoseGraph<Pose>& graph, std::size_t ranges, double sigma_place_m);

}  // namespace radioslam

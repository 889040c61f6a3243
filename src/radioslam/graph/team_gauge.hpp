// Uncertainty of positions in the gauge of the team: of what is left of their errors after the rigid motion
// that carries all of them together onto the truth best (Umeyama, least squares), as trajectories are
// evaluated.
//
// To first order that motion removes G (G^T W G)^-1 G^T W e from the errors e of all positions, with the
// generators G of the rigid motions and weights W. Where the frame is held by one robot's start, the
// covariance of a position is mostly that of the whole team's turn about that start; this is without it.
// Cost: one solution on the factorisation of the marginals for each of the 3 (plane) or 6 generators.
#pragma once

#include <vector>

#include "radioslam/graph/marginals.hpp"

namespace radioslam {

/// Per pose of `of`: covariance of its position, m^2, in the axes of the graph's frame. Weights: one a pose,
/// not negative and not all zero. What the positions leave open (the turn about a line) is removed from none.
template <class Pose>
std::vector<typename Marginals<Pose>::PointCovariance> position_covariances_in_team_gauge(
    const Marginals<Pose>& marginals, const std::vector<Pose>& poses, const std::vector<PoseId>& of,
    const std::vector<double>& weights);

}  // namespace radioslam

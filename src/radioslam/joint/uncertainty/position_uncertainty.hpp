// Stated uncertainty of positions: RobotResult::sigma_position_m relative to what holds the frame,
// sigma_team_m in the gauge of the team.
//
// The marginal covariances are those of one alignment whose accepted evidence is right. Two things widen
// them: likely alternatives, by the spread of the mixture of all; and, where most closures were rejected, the
// factor by which their residuals exceed what is stated (Birge ratio).
#pragma once

#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// From the marginal covariances. The gauge is that of the robots of each component.
template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const TeamAlignment<Pose>& alignment, const Marginals<Pose>& marginals);

/// Adds the squared distances to the alternatives, by weight.
template <class Pose>
void widen_by_alternatives(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                           const TeamAlignment<Pose>& alignment);

/// In the robots' uncertain stretches.
void widen_by_rejected_closures(std::vector<RobotResult>& robots, const std::vector<ClosureResult>& closures,
                                int dimension);

}  // namespace radioslam

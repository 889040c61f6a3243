// Stated uncertainty of positions: RobotResult::sigma_position_m relative to what holds the frame,
// sigma_team_m in the gauge of the team.
//
// The marginal covariances are those of one alignment whose accepted evidence is right. Two things widen
// them: likely alternatives, by the spread of the mixture of all; and, where most closures were rejected, the
// factor by which their residuals exceed what is stated (Birge ratio).
#pragma once

#include <utility>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// Stretches of a robot's trajectory whose evidence was mostly rejected.
//
// Every closure and link of a robot counts at its keyframe: the log likelihood ratio of its status where 95
// % are rejected to the share rejected over the whole mission, by kind. Kinds that are mostly rejected anyway
// (aliased matches, links round corners) say nothing about one stretch. The stretches are the disjoint
// intervals of largest sums, as in a scan statistic, of at least half a minute.

/// Per robot, in time order: first and last keyframe of each stretch.
std::vector<std::vector<std::pair<Stamp, Stamp>>> rejected_stretches(
    std::size_t robots, const std::vector<ClosureResult>& closures);

// Joint graph with factor weights suited for covariances.
//
// For the estimate, links that may be outliers are weighted by their probability of being direct; covariances
// use the smaller observed information (team_frame/measurement_mixture.hpp).

/// Copy of the graph with those weights.
template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture);

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

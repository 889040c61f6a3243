// Stated uncertainty of positions: RobotResult::sigma_position_m relative to what holds the frame,
// sigma_team_m in the gauge of the team.
//
// The marginal covariances are those of one alignment whose accepted evidence is right. Likely alternatives
// widen sigma_team_m by the spread of the mixture of all, a layout by fingerprints both by its own
// uncertainty (team_frame/layout_uncertainty.hpp). Where most closures were rejected, both are widened by the
// factor by which the residuals of distances and angles there exceed what is stated.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// Joint graph with factor weights suited for covariances.
//
// For the estimate, links that may be outliers are weighted by their probability of being direct; covariances
// use the smaller observed information (team_frame/measurement_mixture.hpp).

/// Copy of the graph with those weights.
template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture);

/// Root of the mean variance per axis of a position.
template <class Matrix>
double sigma_of(const Matrix& covariance) {
  return std::sqrt(std::max(0.0, covariance.trace()) / static_cast<double>(covariance.rows()));
}

/// From the marginal covariances. The gauge is that of the robots of each component.
template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const TeamAlignment<Pose>& alignment, const Marginals<Pose>& marginals);

/// Restores what rounding takes from the uncertainty behind motions that nothing measured or tied together
/// since: that of the motion, and a heading that may be any.
template <class Pose>
void widen_by_unknown_motions(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                              const Marginals<Pose>& marginals);

/// Adds the squared distances to the alternatives, by weight, to sigma_team_m.
template <class Pose>
void widen_by_alternatives(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                           const TeamAlignment<Pose>& alignment);

/// Of robots that were placed by fingerprints, by the uncertainty of their layout.
template <class Pose>
void widen_by_layout(std::vector<RobotResult>& robots, const TeamAlignment<Pose>& alignment);

/// In the robots' uncertain stretches.
void widen_by_rejected_closures(std::vector<RobotResult>& robots, const std::vector<ClosureResult>& closures);

}  // namespace radioslam

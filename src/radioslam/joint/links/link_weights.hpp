// Weights of radio links in the joint graph: the one place that sets them.
//
// The weight of a range or of a path of an angle is its posterior under the team's mixture of direct,
// obstructed and false measurements (team_frame/measurement_mixture.hpp) at the graph's values, range biases
// included.
#pragma once

#include <set>
#include <utility>

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

/// The team with its radio links alone.
template <class Pose>
TeamGraph<Pose> radio_team(const JointGraph<Pose>& joint);

/// Takes the values and weights of an alignment of the team's radio ranges and bearings (radio_team). Paths
/// that may be direct become bearing factors, in place of those there were.
template <class Pose>
void adopt_alignment(JointGraph<Pose>& joint, const TeamHypothesis<Pose>& hypothesis);

/// Recomputes the weight of every range and of every path of every bearing at the joint estimate's values,
/// which matches may have changed. Returns the log likelihood of all factors there.
template <class Pose>
double reweigh_radio_links(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                           const MixtureParams& params);

using PairsOfRobots = std::set<std::pair<RobotIndex, RobotIndex>>;

/// Gives the links between these robots no weight.
template <class Pose>
void silence_links(JointGraph<Pose>& joint, const PairsOfRobots& pairs);

}  // namespace radioslam

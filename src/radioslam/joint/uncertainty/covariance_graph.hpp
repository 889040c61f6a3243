// Joint graph with factor weights suited for covariances.
//
// For the estimate, links that may be outliers are weighted by their probability of being direct; covariances
// use the smaller observed information (team_frame/observed_information.hpp).
#pragma once

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

/// Copy of the graph with those weights.
template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture);

}  // namespace radioslam

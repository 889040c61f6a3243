// A joint graph with the weights that its covariances are taken from.
//
// Links that may be false count for the estimate as the alignment weighs them; for what is said about its
// uncertainty they count less (observed_information.hpp).
#pragma once

#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

/// With weights for covariances instead of for the estimate.
template <class Pose>
JointGraph<Pose> honest(const JointGraph<Pose>& joint, const MixtureParams& mixture);

}  // namespace radioslam

#include "radioslam/joint/uncertainty/covariance_graph.hpp"

#include "radioslam/team_frame/observed_information.hpp"

namespace radioslam {

template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture) {
  JointGraph<Pose> result = joint;
  use_observed_information(result.team.graph, count_factors(joint.origins.ranges, FactorSource::kRange),
                           mixture.sigma_antenna_position_m);
  return result;
}

template JointGraph<SE2> graph_for_covariances(const JointGraph<SE2>&, const MixtureParams&);
template JointGraph<SE3> graph_for_covariances(const JointGraph<SE3>&, const MixtureParams&);

}  // namespace radioslam

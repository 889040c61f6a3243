#include "radioslam/pipeline/honest_graph.hpp"

#include "radioslam/team_frame/observed_information.hpp"

namespace radioslam {

template <class Pose>
JointGraph<Pose> honest(const JointGraph<Pose>& joint, const MixtureParams& mixture) {
  JointGraph<Pose> result = joint;
  discount_uncertain_measurements(result.team.graph, joint.first_closure_range, mixture.sigma_place_m);
  return result;
}

template JointGraph<SE2> honest(const JointGraph<SE2>&, const MixtureParams&);
template JointGraph<SE3> honest(const JointGraph<SE3>&, const MixtureParams&);

}  // namespace radioslam

#include "radioslam/team_frame/gravity_priors.hpp"

namespace radioslam {

template <>
void rotate_gravity_priors(PoseGraph<SE2>& /*graph*/) {}

template <>
void rotate_gravity_priors(PoseGraph<SE3>& graph) {
  for (auto& prior : graph.pose_priors) {
    if (!prior.information.row(SE3::kDof - 1).isZero(0)) continue;
    const SE3& pose = graph.poses[prior.i.index()];
    const Eigen::AngleAxisd turn(pose.yaw() - prior.prior.yaw(), Eigen::Vector3d::UnitZ());
    prior.prior = SE3(prior.prior.translation(), turn * prior.prior.rotation());
  }
}

}  // namespace radioslam

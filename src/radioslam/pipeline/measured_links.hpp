// The robots' own odometry and the links between them, for the overlap search's mode "link".
#pragma once

#include <cstddef>

#include "radioslam/closure/overlap_link.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

/// A range and an angle at each of its ends as a relative pose in the plane, receiver i's view first:
/// position d (cos phi, sin phi), yaw phi + pi - psi, with the tangent Jacobian of theory's section 1. The
/// bend of the position's arc over the angle's error lengthens its radial variance by d^2 sigma^4 / 2.
struct MutualBearing {
  double range_m = 0, sigma_range_m = 1;
  double phi_rad = 0, sigma_phi_rad = 1;  ///< of the other robot, seen by the first
  double psi_rad = 0, sigma_psi_rad = 1;  ///< of the first, seen by the other
};
SE2 relative_pose(const MutualBearing& measured);
SE2::Jacobian relative_pose_covariance(const MutualBearing& measured);

/// Odometry of the keyframes and links at keyframes; see overlap_stage.hpp.
template <class Pose>
LinkCovariance<Pose> measured_link_covariance(const JointGraph<Pose>& joint, double pairing_s,
                                              std::size_t most_links);

}  // namespace radioslam

// Mutual bearings as relative poses: each robot's odometry and the links between them, for overlap search in
// mode "link".
#pragma once

#include <cstddef>

#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

/// A range with an angle of arrival at both ends gives a planar relative pose, in the frame of receiver i:
/// position d (cos phi, sin phi), yaw phi + pi - psi. Covariance by its tangent Jacobian; the curvature of
/// the arc swept by the angle's error adds d^2 sigma_phi^4 / 2 to the variance along the line of sight.
struct MutualBearing {
  double range_m = 0, sigma_range_m = 1;
  double phi_rad = 0, sigma_phi_rad = 1;  ///< direction of the second robot, seen by the first
  double psi_rad = 0, sigma_psi_rad = 1;  ///< direction of the first robot, seen by the second
};
SE2 relative_pose(const MutualBearing& measured);
SE2::Jacobian relative_pose_covariance(const MutualBearing& measured);

/// Keyframe odometry of all robots and links between keyframes; see overlap_stage.hpp.
template <class Pose>
struct MeasuredLinks {
  LinkCovariance<Pose> covariance;
  bool estimated =
      false;  ///< no range has angles at both ends: relative poses are those of the joint estimate
};
template <class Pose>
MeasuredLinks<Pose> measured_links(const JointGraph<Pose>& joint, double pairing_s, std::size_t max_links);

}  // namespace radioslam

// Odometry between two samples as one measurement: relative pose, covariance, and its derivative by a
// constant drift. First-order propagation over the samples in between: with increments Z_k, the error is e <-
// Ad(Z_k^-1) e + e_k, so a yaw error early in a segment displaces its end. Covariances are for T * Exp(xi),
// xi = [translation; rotation].
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Motion of the body between two odometry samples.
template <class Pose>
struct OdometryEdge {
  Pose T_i_j;
  typename Pose::Jacobian covariance = Pose::Jacobian::Zero();  ///< of T_i_j, without the constant drift
  /// Derivative of T_i_j's tangent by [yaw drift (rad/m), relative scale error].
  Eigen::Matrix<double, Pose::kDof, 2> drift_jacobian = Eigen::Matrix<double, Pose::kDof, 2>::Zero();
  double distance_m = 0;  ///< path length
};

/// Edge from sample `begin` to sample `end` (begin <= end). For SE2, the motion is projected to the plane.
template <class Pose>
OdometryEdge<Pose> odometry_edge(const Trajectory<SE3>& odometry, std::size_t begin, std::size_t end,
                                 const OdometryNoise& noise);

/// Extends an edge by the motion from one sample to the next, without the variance floor that odometry_edge()
/// adds once to every edge.
template <class Pose>
void append_sample(OdometryEdge<Pose>& edge, const StampedPose<SE3>& from, const StampedPose<SE3>& to,
                   const OdometryNoise& noise);

/// Composition of two consecutive edges.
template <class Pose>
OdometryEdge<Pose> followed_by(const OdometryEdge<Pose>& edge, const OdometryEdge<Pose>& next);

/// The motion, with the priors of constant drift and scale error in its covariance.
template <class Pose>
UncertainPose<Pose> with_drift(const OdometryEdge<Pose>& edge, const OdometryNoise& noise);

/// Variance floor (diagonal): keeps the covariance of an edge invertible when the robot does not move.
template <class Pose>
typename Pose::Tangent min_edge_variance();

/// Recorded noise between two times; steps are included in proportion to their overlap.
SE3::Jacobian measured_covariance(const std::vector<OdometryStepNoise>& steps, Stamp begin, Stamp end);

/// Path length from the first sample to each sample, metres.
std::vector<double> travelled_distance(const Trajectory<SE3>& odometry);

/// Path length at a stamp, interpolated and clamped to the ends.
double travelled_distance_at(const Trajectory<SE3>& odometry, const std::vector<double>& travelled_m,
                             Stamp stamp);

// Odometry between any two times with its full covariance: the random walk of odometry_edge.hpp and the
// priors of constant drift and scale error.

/// T_from_to with its covariance, for either order of the times, both of which the odometry must cover.
/// Cost: linear in the samples between them.
template <class Pose>
UncertainPose<Pose> odometry_between(const Robot& robot, Stamp from, Stamp to);

/// T_start_body at each of these times, which must not decrease and be covered. Cost: linear in samples and
/// times.
template <class Pose>
std::vector<UncertainPose<Pose>> odometry_since_start(const Robot& robot, const std::vector<Stamp>& stamps);

}  // namespace radioslam

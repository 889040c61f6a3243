// The odometry between two rows as one measurement: motion, covariance, and how a constant drift bends it.
// First-order propagation over the rows in between: with increments Z_k, error e <- Ad(Z_k^-1) e + e_k, so a
// yaw error early in a segment moves its end. Covariances are for T * Exp(xi), xi = [translation; rotation].
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Motion of the body between two odometry rows.
template <class Pose>
struct OdometryEdge {
  Pose T_i_j;
  typename Pose::Jacobian covariance = Pose::Jacobian::Zero();  ///< of T_i_j, without the constant drift
  /// Change of T_i_j's tangent per unit of [yaw drift (rad/m), relative scale error].
  Eigen::Matrix<double, Pose::kDof, 2> drift_jacobian = Eigen::Matrix<double, Pose::kDof, 2>::Zero();
  double distance_m = 0;  ///< along the rows
};

/// The edge from row `begin` to row `end` (begin <= end). Pose SE2 looks from above.
template <class Pose>
OdometryEdge<Pose> odometry_edge(const Trajectory<SE3>& odometry, std::size_t begin, std::size_t end,
                                 const OdometryNoise& noise);

/// Extends an edge by the motion from one row to the next. The covariance comes without the floor that
/// odometry_edge() adds once to every edge.
template <class Pose>
void append_row(OdometryEdge<Pose>& edge, const StampedPose<SE3>& from, const StampedPose<SE3>& to,
                const OdometryNoise& noise);

/// Both edges as one.
template <class Pose>
OdometryEdge<Pose> followed_by(const OdometryEdge<Pose>& edge, const OdometryEdge<Pose>& next);

/// That floor, on the diagonal: standing still is known well, not perfectly, and an edge's covariance must be
/// invertible.
template <class Pose>
typename Pose::Tangent least_edge_variance();

/// What was measured of the noise between two times: of every step its share.
SE3::Jacobian measured_covariance(const std::vector<OdometryStepNoise>& steps, Stamp begin, Stamp end);

/// Distance walked from the first row to each row, metres.
std::vector<double> distance_walked(const Trajectory<SE3>& odometry);

/// Distance walked at a stamp, interpolated; clamped to the ends.
double distance_walked_at(const Trajectory<SE3>& odometry, const std::vector<double>& walked, Stamp stamp);

}  // namespace radioslam

// Covariance of a robot's odometry between any two of its poses, in O(1) from prefix sums:
//   S_j = sum over k < j of Ad(T_k+1) Q_k Ad(T_k+1)^T,  Cov(eta_j - eta_i) = S_j - S_i  for i <= j
// with Q_k the covariance of the increment T_k^-1 T_k+1 (right perturbation). As a right perturbation of
// T_i^-1 T_j the covariance is Ad(T_j^-1) (S_j - S_i) Ad(T_j^-1)^T.
//
// The difference suffers cancellation: S contains (distance from the frame's origin)^2 times the yaw
// variance. The origin is therefore the mean of the poses and the sums are compensated (Neumaier), which
// leaves an error of a few units in the last place of S: 1e-8 m^2 for 10 km and 1 rad. rounding_bound()
// bounds it, and the bounds of the overlap search include it.
#pragma once

#include <limits>

#include "radioslam/closure/overlap/overlap_relative.hpp"
#include "radioslam/geometry/compensated_sum.hpp"

namespace radioslam {

/// Error of a difference of prefix sums, relative to the sums.
inline constexpr double kRoundingOfSums = 64 * std::numeric_limits<double>::epsilon();

/// Bounds of the standard deviations of position, at point p, and rotation caused by this relative error of
/// `sum`.
template <class Pose>
PoseSpread rounding_bound(const typename Pose::Jacobian& sum, const typename Pose::Point& p,
                          double relative_error) {
  constexpr int kDim = Pose::kDim, kRotation = Pose::kDof - Pose::kDim;
  const double tt = sum.template topLeftCorner<kDim, kDim>().norm();
  const double tr = sum.template topRightCorner<kDim, kRotation>().norm();
  const double rr = sum.template bottomRightCorner<kRotation, kRotation>().norm();
  const double lever = p.norm();
  return {std::sqrt(relative_error * (tt + 2 * lever * tr + lever * lever * rr)),
          std::sqrt(relative_error * rr)};
}

}  // namespace radioslam

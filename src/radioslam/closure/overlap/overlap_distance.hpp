// Distance of two views from overlapping, in standard deviations of the relative position.
//
//   minimum        d_min = min over |x| <= r of sqrt((dp - x)^T S^-1 (dp - x)),   x = (I + mu S)^-1 dp, |x| =
//   r line of sight  d*    = sqrt(q^T S^-1 q), q = (|dp| - r) u, u = dp / |dp|   (Wi-Closure, Wang et al.,
//   eq. 4.2-4.3)
//
// dp (m) is the position of pose l seen from pose k, S (m^2) its covariance in the same axes, r the distance
// up to which views overlap: the sum of the two sensor ranges, or less (overlap_view.hpp). Both are 0 for
// |dp| <= r, d_min <= d*, and both are invariant to rotation of the axes. Duality: d_min = max over unit u
// of (u^T dp - r) / sqrt(u^T S u). The maximising u is the normal of the plane that touches the ball at its
// nearest point; the search bounds whole boxes of poses with it. S may be singular: along directions of zero
// variance the distance is infinite. Negative eigenvalues (rounding) count as 0. Cost: one small
// eigendecomposition; the root mu by Newton's method on 1 / |x|, which is concave in mu (a power mean of
// affine functions), so that the iteration increases from mu = 0 without overshooting.
#pragma once

#include <Eigen/Core>

namespace radioslam {

enum class OverlapDistance {
  kMinimum,      ///< d_min
  kLineOfSight,  ///< d*
};

/// A distance and the unit normal that attains it; inside the ball both are zero.
template <int Dim>
struct SupportedDistance {
  double mahalanobis = 0;
  Eigen::Matrix<double, Dim, 1> normal = Eigen::Matrix<double, Dim, 1>::Zero();
};

template <int Dim>
SupportedDistance<Dim> minimum_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                                        const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m);

template <int Dim>
double line_of_sight_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                              const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m);

}  // namespace radioslam

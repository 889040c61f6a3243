// How far two views are from overlapping, in standard deviations of where one robot is seen from the other.
//
//   minimum   d_min = min over |x| <= r of sqrt((dp - x)^T S^-1 (dp - x)),   x = (I + mu S)^-1 dp, |x| = r
//   seed      d*    = sqrt(q^T S^-1 q), q = (|dp| - r) u, u = dp / |dp|      (Wi-Closure, eq. 4.2-4.3)
//
// dp (m) is the position of pose l seen from pose k, S (m^2) its covariance in the same axes, r = r_a + r_b
// the sum of the two ranges. Both are 0 for |dp| <= r, and d_min <= d*. Turning the axes changes neither.
// Duality: d_min = max over unit u of (u^T dp - r) / sqrt(u^T S u). The u that attains it is the normal of
// the plane that touches the ball where it is nearest; the search bounds whole boxes of poses with it. S may
// be singular: what it cannot explain is infinitely far. Negative eigenvalues (rounding) count as 0. Cost:
// one small eigendecomposition; the root mu by Newton on 1 / |x|, which is concave in mu (a power mean of
// affine functions), so that it climbs from mu = 0 without overshooting.
#pragma once

#include <Eigen/Core>

namespace radioslam {

enum class OverlapDistance {
  kMinimum,  ///< d_min
  kSeed,     ///< d*
};

/// A distance with the unit normal that attains it; inside the ball the distance is 0 and the normal zero.
template <int Dim>
struct SupportedDistance {
  double mahalanobis = 0;
  Eigen::Matrix<double, Dim, 1> normal = Eigen::Matrix<double, Dim, 1>::Zero();
};

template <int Dim>
SupportedDistance<Dim> minimum_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                                        const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m);

template <int Dim>
double seed_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                     const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m);

}  // namespace radioslam

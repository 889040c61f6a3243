#include "radioslam/closure/overlap/overlap_distance.hpp"

#include <cmath>
#include <limits>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Newton's method takes 3-8 steps on typical pairs; a nearly singular covariance takes some tens, each of
/// which multiplies mu by 1.5.
constexpr int kMaxSteps = 300;
/// Relative steps of mu below this are rounding.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

/// dp and S in the principal axes of S, with eigenvalues relative to the largest.
template <int Dim>
struct PrincipalAxes {
  using Vector = Eigen::Matrix<double, Dim, 1>;
  Eigen::Matrix<double, Dim, Dim> axes;
  Vector eigenvalue_ratio = Vector::Zero(), difference;
  double largest = 0;  ///< eigenvalue, m^2

  PrincipalAxes(const Vector& difference_m, const Eigen::Matrix<double, Dim, Dim>& covariance) {
    SymmetricEigen<Eigen::Matrix<double, Dim, Dim>> eigen;
    if constexpr (Dim == 2)
      eigen = symmetric_eigen_direct(covariance);
    else
      eigen = symmetric_eigen(covariance);
    axes = eigen.vectors;
    difference = axes.transpose() * difference_m;
    largest = std::max(0.0, eigen.values[Dim - 1]);
    if (largest > 0) eigenvalue_ratio = (eigen.values / largest).cwiseMax(0.0);
  }
  /// Part of the difference along axes of zero variance.
  Vector unexplained() const { return (eigenvalue_ratio.array() > 0).select(Vector::Zero(), difference); }
};

/// sum of b_i^2 / lambda_i over the axes with lambda_i > 0.
template <int Dim>
double explained_norm(const PrincipalAxes<Dim>& p) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i)
    if (p.eigenvalue_ratio[i] > 0) sum += p.difference[i] * p.difference[i] / p.eigenvalue_ratio[i];
  return std::sqrt(sum / p.largest);
}

/// mu with |(I + mu S)^-1 dp| = radius, for S relative to its largest eigenvalue.
template <int Dim>
double contact_multiplier(const PrincipalAxes<Dim>& p, double radius_m) {
  double mu = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto weight = (1 + mu * p.eigenvalue_ratio.array()).eval();
    const auto x = (p.difference.array() / weight).eval();
    const double squared = x.square().sum();
    const double slope = (p.eigenvalue_ratio.array() * x.square() / weight).sum();
    const double increase = (std::sqrt(squared) / radius_m - 1) * squared / slope;
    if (!(increase > kRounding * mu)) break;
    mu += increase;
  }
  return mu;
}

}  // namespace

template <int Dim>
SupportedDistance<Dim> minimum_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                                        const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m) {
  using Vector = Eigen::Matrix<double, Dim, 1>;
  if (difference_m.norm() <= radius_m) return {};
  const PrincipalAxes<Dim> p(difference_m, covariance);
  const Vector unexplained = p.unexplained();
  const double beyond = unexplained.norm();
  if (beyond > radius_m) return {std::numeric_limits<double>::infinity(), p.axes * (unexplained / beyond)};
  if (beyond == radius_m) {  // mu is infinite: the ball's nearest point has no component along the other axes
    const Vector pull =
        (p.eigenvalue_ratio.array() > 0).select(p.difference.array() / p.eigenvalue_ratio.array(), 0.0);
    const Vector normal = beyond > 0 ? Vector(unexplained) : pull;
    return {explained_norm(p), p.axes * normal.normalized()};
  }
  const double mu = contact_multiplier(p, radius_m);
  const Vector x = (p.difference.array() / (1 + mu * p.eigenvalue_ratio.array())).matrix();
  const double squared = (p.eigenvalue_ratio.array() * x.array().square()).sum() / p.largest;
  return {mu * std::sqrt(squared), p.axes * x.normalized()};
}

template <int Dim>
double line_of_sight_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
                              const Eigen::Matrix<double, Dim, Dim>& covariance, double radius_m) {
  const double distance = difference_m.norm();
  if (distance <= radius_m) return 0;
  const PrincipalAxes<Dim> p(difference_m, covariance);
  if (!p.unexplained().isZero(0)) return std::numeric_limits<double>::infinity();
  return (distance - radius_m) / distance * explained_norm(p);
}

#define RADIOSLAM_OVERLAP_DISTANCE(Dim)                                                                  \
  template SupportedDistance<Dim> minimum_distance<Dim>(const Eigen::Matrix<double, Dim, 1>&,            \
                                                        const Eigen::Matrix<double, Dim, Dim>&, double); \
  template double line_of_sight_distance<Dim>(const Eigen::Matrix<double, Dim, 1>&,                      \
                                              const Eigen::Matrix<double, Dim, Dim>&, double)
RADIOSLAM_OVERLAP_DISTANCE(2);
RADIOSLAM_OVERLAP_DISTANCE(3);

}  // namespace radioslam

#include "radioslam/closure/overlap_distance.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace radioslam {
namespace {

/// Newton needs 3-8 steps on ordinary pairs; a singular covariance that nearly fails to explain the distance
/// needs some tens, each multiplying mu by 1.5.
constexpr int kMostSteps = 300;
/// Steps below this share of mu are rounding.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

/// dp and S in the principal axes of S, with eigenvalues as shares of the largest.
template <int Dim>
struct PrincipalAxes {
  using Vector = Eigen::Matrix<double, Dim, 1>;
  Eigen::Matrix<double, Dim, Dim> axes;
  Vector share = Vector::Zero(), difference;
  double largest = 0;  ///< eigenvalue, m^2

  PrincipalAxes(const Vector& difference_m, const Eigen::Matrix<double, Dim, Dim>& covariance) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> solver;
    if constexpr (Dim == 2)
      solver.computeDirect(covariance);
    else
      solver.compute(covariance);
    axes = solver.eigenvectors();
    difference = axes.transpose() * difference_m;
    largest = std::max(0.0, solver.eigenvalues()[Dim - 1]);
    if (largest > 0) share = (solver.eigenvalues() / largest).cwiseMax(0.0);
  }
  /// The part of the difference that the covariance cannot explain.
  Vector unexplained() const { return (share.array() > 0).select(Vector::Zero(), difference); }
};

/// sum of b_i^2 / lambda_i over the axes with lambda_i > 0.
template <int Dim>
double explained_norm(const PrincipalAxes<Dim>& p) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i)
    if (p.share[i] > 0) sum += p.difference[i] * p.difference[i] / p.share[i];
  return std::sqrt(sum / p.largest);
}

/// mu with |(I + mu S)^-1 dp| = radius, for S in shares of its largest eigenvalue.
template <int Dim>
double contact_multiplier(const PrincipalAxes<Dim>& p, double radius_m) {
  double mu = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto weight = (1 + mu * p.share.array()).eval();
    const auto x = (p.difference.array() / weight).eval();
    const double squared = x.square().sum();
    const double slope = (p.share.array() * x.square() / weight).sum();
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
  if (beyond == radius_m) {  // mu is infinite: the ball's nearest point has nothing along the other axes
    const Vector pull = (p.share.array() > 0).select(p.difference.array() / p.share.array(), 0.0);
    const Vector normal = beyond > 0 ? Vector(unexplained) : pull;
    return {explained_norm(p), p.axes * normal.normalized()};
  }
  const double mu = contact_multiplier(p, radius_m);
  const Vector x = (p.difference.array() / (1 + mu * p.share.array())).matrix();
  const double squared = (p.share.array() * x.array().square()).sum() / p.largest;
  return {mu * std::sqrt(squared), p.axes * x.normalized()};
}

template <int Dim>
double seed_distance(const Eigen::Matrix<double, Dim, 1>& difference_m,
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
  template double seed_distance<Dim>(const Eigen::Matrix<double, Dim, 1>&,                               \
                                     const Eigen::Matrix<double, Dim, Dim>&, double)
RADIOSLAM_OVERLAP_DISTANCE(2);
RADIOSLAM_OVERLAP_DISTANCE(3);

}  // namespace radioslam

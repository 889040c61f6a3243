#include "radioslam/radio/ranging/anchor_frame.hpp"

#include <cmath>

namespace radioslam {
namespace {

using Eigen::Index;

/// Column of the point `wanted` or, by default, of the first whose norm exceeds `bar`; nothing if there is
/// none.
std::optional<Index> off_point(const Eigen::MatrixXd& rows, std::optional<std::size_t> wanted, double bar) {
  for (Index k = 0; k < rows.cols(); ++k) {
    if (wanted && k != static_cast<Index>(*wanted)) continue;
    if (rows.col(k).norm() > bar) return k;
  }
  return std::nullopt;
}

/// Orthogonal matrix whose first row is along `direction`.
Eigen::MatrixXd turn_to_first_axis(const Eigen::VectorXd& direction) {
  const Index d = direction.size();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(d, d);
  basis.col(0) = direction.normalized();
  Index kept = 1;
  for (Index axis = 0; axis < d && kept < d; ++axis) {  // Gram-Schmidt over the axes
    Eigen::VectorXd next = Eigen::VectorXd::Unit(d, axis);
    for (Index k = 0; k < kept; ++k) next -= basis.col(k) * basis.col(k).dot(next);
    constexpr double kIndependent = 0.1;  // at least one axis keeps a larger component
    if (next.norm() > kIndependent) basis.col(kept++) = next.normalized();
  }
  return basis.transpose();
}

}  // namespace

std::optional<Eigen::MatrixXd> in_anchor_frame(const Eigen::MatrixXd& points, const AnchorFrame& frame,
                                               double clearance) {
  const Index d = points.rows();
  const auto origin = static_cast<Index>(frame.origin.value_or(0));
  Eigen::MatrixXd placed = points.colwise() - points.col(origin);
  const double bar = clearance * placed.colwise().norm().maxCoeff();
  const std::optional<std::size_t> wanted[3] = {frame.along_x, frame.left, std::nullopt};
  for (Index axis = 0; axis < d; ++axis) {
    Eigen::MatrixXd rest = placed.bottomRows(d - axis);
    const auto chosen = off_point(rest, wanted[axis], bar);
    if (!chosen) return std::nullopt;
    placed.bottomRows(d - axis) = turn_to_first_axis(rest.col(*chosen)) * rest;
  }
  return placed;
}

}  // namespace radioslam

#include "radioslam/team_frame/multidimensional_scaling.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kSubspace = 6;  // two, and a guard against near-equal eigenvalues
constexpr int kIterations = 100;

/// -1/2 J D^2 J with J = I - 1/n.
Eigen::MatrixXd doubly_centred(const Eigen::MatrixXd& distances) {
  Eigen::MatrixXd b = -0.5 * distances.array().square().matrix();
  const Eigen::RowVectorXd column_means = b.colwise().mean();
  b.rowwise() -= column_means;
  const Eigen::VectorXd row_means = b.rowwise().mean();
  b.colwise() -= row_means;
  return b;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& m) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(m).householderQ() *
         Eigen::MatrixXd::Identity(m.rows(), m.cols());
}

}  // namespace

Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m) {
  const Eigen::Index n = distances_m.rows();
  const Eigen::Index k = std::min(kSubspace, n);
  if (n < 2) return Eigen::Matrix2Xd::Zero(2, n);
  const Eigen::MatrixXd b = doubly_centred(distances_m);

  // Subspace iteration from a fixed start. Only the two largest positive eigenvalues are used; distances that
  // no planar configuration realises also give negative ones.
  Rng rng(1);
  Eigen::MatrixXd q = Eigen::MatrixXd::NullaryExpr(n, k, [&] { return rng.normal(); });
  q = orthonormal(q);
  for (int i = 0; i < kIterations; ++i) q = orthonormal(b * q);
  const auto small = symmetric_eigen<Eigen::MatrixXd>(q.transpose() * b * q);
  Eigen::Matrix2Xd points = Eigen::Matrix2Xd::Zero(2, n);
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, k); ++axis) {
    const Eigen::Index e = k - 1 - axis;
    const double scale = std::sqrt(std::max(0.0, small.values[e]));
    points.row(axis) = scale * (q * small.vectors.col(e)).transpose();
  }
  return points;
}

}  // namespace radioslam

#include "radioslam/io/graph/information.hpp"

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Scales the largest magnitude to 1, so that products do not overflow.
template <int N>
Eigen::Matrix<double, N, N> scaled(const Eigen::Matrix<double, N, N>& m, double magnitude) {
  return m / magnitude;
}

}  // namespace

template <int N>
double relative_smallest_eigenvalue(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return 0;
  const Eigen::Matrix<double, N, 1> values = symmetric_eigenvalues(scaled(symmetric, magnitude));
  return values(0) / values.cwiseAbs().maxCoeff();
}

template <int N>
bool is_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return true;
  const Cholesky<Eigen::Matrix<double, N, N>> cholesky(scaled(symmetric, magnitude));
  return cholesky.succeeded() || relative_smallest_eigenvalue(symmetric) >= -kInformationRounding;
}

template <int N>
Eigen::Matrix<double, N, N> nearest_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return symmetric;
  const SymmetricEigen<Eigen::Matrix<double, N, N>> eigen = symmetric_eigen(scaled(symmetric, magnitude));
  const Eigen::Matrix<double, N, 1> values = eigen.values.cwiseMax(kClippedInformation) * magnitude;
  const Eigen::Matrix<double, N, N> nearest = eigen.vectors * values.asDiagonal() * eigen.vectors.transpose();
  return 0.5 * (nearest + nearest.transpose());
}

template <int N>
std::optional<Eigen::Matrix<double, N, N>> information_of(const Eigen::Matrix<double, N, N>& covariance) {
  const Cholesky<Eigen::Matrix<double, N, N>> cholesky(covariance);
  const Eigen::Matrix<double, N, N> information = cholesky.inverse();
  if (!cholesky.succeeded() || !information.allFinite()) return std::nullopt;
  return (information + information.transpose()) / 2;
}

template double relative_smallest_eigenvalue(const Eigen::Matrix2d&);
template double relative_smallest_eigenvalue(const Eigen::Matrix3d&);
template double relative_smallest_eigenvalue(const Eigen::Matrix<double, 6, 6>&);
template bool is_information(const Eigen::Matrix2d&);
template bool is_information(const Eigen::Matrix3d&);
template bool is_information(const Eigen::Matrix<double, 6, 6>&);
template Eigen::Matrix2d nearest_information(const Eigen::Matrix2d&);
template Eigen::Matrix3d nearest_information(const Eigen::Matrix3d&);
template Eigen::Matrix<double, 6, 6> nearest_information(const Eigen::Matrix<double, 6, 6>&);
template std::optional<Eigen::Matrix2d> information_of(const Eigen::Matrix2d&);
template std::optional<Eigen::Matrix3d> information_of(const Eigen::Matrix3d&);
template std::optional<Eigen::Matrix<double, 6, 6>> information_of(const Eigen::Matrix<double, 6, 6>&);

}  // namespace radioslam

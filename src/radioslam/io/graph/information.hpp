// Checks whether a symmetric matrix from a file is a valid information matrix, and computes the nearest valid
// one. Nearest means in the Frobenius norm: negative eigenvalues are clipped (Higham 1988). Because files
// round to about six digits, eigenvalues slightly below zero, relative to the largest one, are accepted.
// Matrices are divided by their largest magnitude, so that products do not overflow.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

/// Largest accepted magnitude of a negative eigenvalue, relative to the largest one (rounding to six digits).
inline constexpr double kInformationRounding = 1e-6;
/// Value of clipped eigenvalues relative to the largest one, so that the matrix remains invertible.
inline constexpr double kClippedInformation = 1e-9;

/// Smallest eigenvalue over the largest magnitude of all; 0 for the zero matrix.
template <int N>
double relative_smallest_eigenvalue(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return 0;
  const Eigen::Matrix<double, N, 1> values =
      symmetric_eigenvalues(Eigen::Matrix<double, N, N>(symmetric / magnitude));
  return values(0) / values.cwiseAbs().maxCoeff();
}

/// Whether the matrix is positive semidefinite up to rounding. N is 2, 3 or 6.
template <int N>
bool is_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return true;
  const Cholesky<Eigen::Matrix<double, N, N>> cholesky(Eigen::Matrix<double, N, N>(symmetric / magnitude));
  return cholesky.succeeded() || relative_smallest_eigenvalue(symmetric) >= -kInformationRounding;
}

/// The nearest positive definite matrix.
template <int N>
Eigen::Matrix<double, N, N> nearest_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return symmetric;
  const SymmetricEigen<Eigen::Matrix<double, N, N>> eigen =
      symmetric_eigen(Eigen::Matrix<double, N, N>(symmetric / magnitude));
  const Eigen::Matrix<double, N, 1> values = eigen.values.cwiseMax(kClippedInformation) * magnitude;
  const Eigen::Matrix<double, N, N> nearest = eigen.vectors * values.asDiagonal() * eigen.vectors.transpose();
  return 0.5 * (nearest + nearest.transpose());
}

/// Inverse of a covariance; nothing if it is not positive definite.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> information_of(const Eigen::Matrix<double, N, N>& covariance) {
  const Cholesky<Eigen::Matrix<double, N, N>> cholesky(covariance);
  const Eigen::Matrix<double, N, N> information = cholesky.inverse();
  if (!cholesky.succeeded() || !information.allFinite()) return std::nullopt;
  return (information + information.transpose()) / 2;
}

}  // namespace radioslam

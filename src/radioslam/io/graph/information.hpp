// Checks whether a symmetric matrix from a file is a valid information matrix, and computes the nearest valid
// one. Nearest means in the Frobenius norm: negative eigenvalues are clipped (Higham 1988). Because files
// round to about six digits, eigenvalues slightly below zero, relative to the largest one, are accepted.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace radioslam {

/// Largest accepted magnitude of a negative eigenvalue, relative to the largest one (rounding to six digits).
inline constexpr double kInformationRounding = 1e-6;
/// Value of clipped eigenvalues relative to the largest one, so that the matrix remains invertible.
inline constexpr double kClippedInformation = 1e-9;

/// Smallest eigenvalue over the largest magnitude of all; 0 for the zero matrix.
template <int N>
double relative_smallest_eigenvalue(const Eigen::Matrix<double, N, N>& symmetric);

/// Whether the matrix is positive semidefinite up to rounding. N is 2, 3 or 6.
template <int N>
bool is_information(const Eigen::Matrix<double, N, N>& symmetric);

/// The nearest positive definite matrix.
template <int N>
Eigen::Matrix<double, N, N> nearest_information(const Eigen::Matrix<double, N, N>& symmetric);

/// Inverse of a covariance; nothing if it is not positive definite.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> information_of(const Eigen::Matrix<double, N, N>& covariance);

}  // namespace radioslam

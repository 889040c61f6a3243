// Is a symmetric matrix from a file an information matrix, and if not, which one is nearest?
// Nearest in the Frobenius norm: negative eigenvalues are clipped (Higham 1988). Files round to about six
// digits, so an eigenvalue may come out slightly below zero; relative to the largest one that is accepted.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// Smallest eigenvalue accepted, as a share of the largest magnitude; the rounding of six digits.
inline constexpr double kInformationRounding = 1e-6;
/// What clipped eigenvalues become, as a share of the largest: still invertible.
inline constexpr double kClippedInformation = 1e-9;

/// Smallest eigenvalue over the largest magnitude; 0 for the zero matrix.
template <int N>
double relative_smallest_eigenvalue(const Eigen::Matrix<double, N, N>& symmetric);

/// Positive semidefinite up to rounding. N is 2, 3 or 6.
template <int N>
bool is_information(const Eigen::Matrix<double, N, N>& symmetric);

/// The nearest positive definite matrix.
template <int N>
Eigen::Matrix<double, N, N> nearest_information(const Eigen::Matrix<double, N, N>& symmetric);

}  // namespace radioslam

#include "radioslam/io/information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace radioslam {
namespace {

/// Scaled to a largest magnitude of 1, so that no product overflows.
template <int N>
Eigen::Matrix<double, N, N> scaled(const Eigen::Matrix<double, N, N>& m, double magnitude) {
  return m / magnitude;
}

}  // namespace

template <int N>
double relative_smallest_eigenvalue(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(scaled(symmetric, magnitude),
                                                                          Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0) / solver.eigenvalues().cwiseAbs().maxCoeff();
}

template <int N>
bool is_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return true;
  const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(scaled(symmetric, magnitude));
  return llt.info() == Eigen::Success || relative_smallest_eigenvalue(symmetric) >= -kInformationRounding;
}

template <int N>
Eigen::Matrix<double, N, N> nearest_information(const Eigen::Matrix<double, N, N>& symmetric) {
  const double magnitude = symmetric.cwiseAbs().maxCoeff();
  if (magnitude == 0) return symmetric;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(scaled(symmetric, magnitude));
  const Eigen::Matrix<double, N, 1> values = solver.eigenvalues().cwiseMax(kClippedInformation) * magnitude;
  const Eigen::Matrix<double, N, N> nearest =
      solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
  return 0.5 * (nearest + nearest.transpose());
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

}  // namespace radioslam

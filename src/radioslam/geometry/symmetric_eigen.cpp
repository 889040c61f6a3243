#include <Eigen/Eigenvalues>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

// Of fixed sizes Eigen decomposes 3x3 in a way of its own; the others it computes as matrices of any size,
// bit for bit.
template <class Matrix>
using DecomposedAs =
    std::conditional_t<std::is_same_v<typename Matrix::Scalar, double> && Matrix::RowsAtCompileTime != 3,
                       Eigen::MatrixXd, Matrix>;

template <class Matrix>
SymmetricEigen<Matrix> symmetric_eigen(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<DecomposedAs<Matrix>> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <class Matrix>
RealColumnOf<Matrix> symmetric_eigenvalues(const Matrix& a) {
  return Eigen::SelfAdjointEigenSolver<DecomposedAs<Matrix>>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricEigen<Eigen::Matrix2d> symmetric_eigen_direct(const Eigen::Matrix2d& a) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;

template SymmetricEigen<Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d&);
template SymmetricEigen<Eigen::Matrix3d> symmetric_eigen(const Eigen::Matrix3d&);
template SymmetricEigen<Matrix6> symmetric_eigen(const Matrix6&);
template SymmetricEigen<Eigen::MatrixXd> symmetric_eigen(const Eigen::MatrixXd&);
template SymmetricEigen<Eigen::MatrixXcd> symmetric_eigen(const Eigen::MatrixXcd&);
template RealColumnOf<Eigen::Matrix2d> symmetric_eigenvalues(const Eigen::Matrix2d&);
template RealColumnOf<Eigen::Matrix3d> symmetric_eigenvalues(const Eigen::Matrix3d&);
template RealColumnOf<Matrix6> symmetric_eigenvalues(const Matrix6&);

}  // namespace radioslam

#include <Eigen/Cholesky>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Matrix>
Cholesky<Matrix>::Cholesky(const Matrix& a) {
  const Eigen::LLT<Matrix> llt(a);
  factor_ = llt.matrixLLT();
  succeeded_ = llt.info() == Eigen::Success;
}

template <class Matrix>
Matrix Cholesky<Matrix>::lower() const {
  return factor_.template triangularView<Eigen::Lower>();
}

template <class Matrix>
ColumnOf<Matrix> Cholesky<Matrix>::solve(const ColumnOf<Matrix>& b) const {
  ColumnOf<Matrix> x = b;
  factor_.template triangularView<Eigen::Lower>().solveInPlace(x);
  factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

template <class Matrix>
Matrix Cholesky<Matrix>::solve_matrix(const Matrix& b) const {
  Matrix x = b;
  factor_.template triangularView<Eigen::Lower>().solveInPlace(x);
  factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

template <class Matrix>
Matrix Cholesky<Matrix>::inverse() const {
  return solve_matrix(Matrix::Identity(factor_.rows(), factor_.cols()));
}

template <class Matrix>
Matrix Cholesky<Matrix>::schur_complement(const Matrix& c, const Matrix& b) const {
  Eigen::Matrix<typename Matrix::Scalar, Matrix::ColsAtCompileTime, Matrix::RowsAtCompileTime,
                Eigen::RowMajor>
      x = b.transpose();
  factor_.template triangularView<Eigen::Lower>().solveInPlace(x);
  factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(x);
  return c - b * x;
}

template <class Matrix>
ColumnOf<Matrix> Cholesky<Matrix>::whitened(const ColumnOf<Matrix>& b) const {
  return factor_.template triangularView<Eigen::Lower>().solve(b);
}

template <class Matrix>
Matrix Cholesky<Matrix>::whitened_matrix(const Matrix& b) const {
  return factor_.template triangularView<Eigen::Lower>().solve(b);
}

template <class Matrix>
std::optional<Matrix> inverse_if_regular(const Matrix& a, double min_condition) {
  const Eigen::LLT<Matrix> llt(a);
  if (llt.info() != Eigen::Success || !(llt.rcond() > min_condition)) return std::nullopt;
  return Matrix(llt.solve(Matrix::Identity(a.rows(), a.cols())));
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix21 = Eigen::Matrix<double, 21, 21>;  // of the inertial state

// Only what is used: each of these takes the compiler up to a second.
template Cholesky<Eigen::Matrix2d>::Cholesky(const Eigen::Matrix2d&);
template Eigen::Matrix2d Cholesky<Eigen::Matrix2d>::inverse() const;
template Cholesky<Eigen::Matrix3d>::Cholesky(const Eigen::Matrix3d&);
template Eigen::Matrix3d Cholesky<Eigen::Matrix3d>::inverse() const;
template Eigen::Matrix3d Cholesky<Eigen::Matrix3d>::lower() const;
template Eigen::Matrix3d Cholesky<Eigen::Matrix3d>::solve_matrix(const Eigen::Matrix3d&) const;
template Eigen::Vector3d Cholesky<Eigen::Matrix3d>::solve(const Eigen::Vector3d&) const;
template Eigen::Matrix3d Cholesky<Eigen::Matrix3d>::whitened_matrix(const Eigen::Matrix3d&) const;
template Eigen::Vector3d Cholesky<Eigen::Matrix3d>::whitened(const Eigen::Vector3d&) const;
template Cholesky<Matrix6>::Cholesky(const Matrix6&);
template Matrix6 Cholesky<Matrix6>::inverse() const;
template Matrix6 Cholesky<Matrix6>::lower() const;
template Matrix6 Cholesky<Matrix6>::solve_matrix(const Matrix6&) const;
template Matrix6 Cholesky<Matrix6>::whitened_matrix(const Matrix6&) const;
template ColumnOf<Matrix6> Cholesky<Matrix6>::whitened(const ColumnOf<Matrix6>&) const;
template Cholesky<Matrix21>::Cholesky(const Matrix21&);
template Matrix21 Cholesky<Matrix21>::inverse() const;
template Matrix21 Cholesky<Matrix21>::lower() const;
template Matrix21 Cholesky<Matrix21>::schur_complement(const Matrix21&, const Matrix21&) const;
template ColumnOf<Matrix21> Cholesky<Matrix21>::solve(const ColumnOf<Matrix21>&) const;
template Cholesky<Eigen::MatrixXd>::Cholesky(const Eigen::MatrixXd&);
template Eigen::VectorXd Cholesky<Eigen::MatrixXd>::solve(const Eigen::VectorXd&) const;
template Eigen::VectorXd Cholesky<Eigen::MatrixXd>::whitened(const Eigen::VectorXd&) const;
template Eigen::MatrixXd Cholesky<Eigen::MatrixXd>::whitened_matrix(const Eigen::MatrixXd&) const;

template std::optional<Eigen::Matrix3d> inverse_if_regular(const Eigen::Matrix3d&, double);
template std::optional<Matrix6> inverse_if_regular(const Matrix6&, double);

}  // namespace radioslam

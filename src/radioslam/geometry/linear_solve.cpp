#include <Eigen/Cholesky>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Matrix>
ColumnOf<Matrix> ldlt_solve(const Matrix& a, const std::type_identity_t<ColumnOf<Matrix>>& b) {
  return a.ldlt().solve(b);
}

template <class Matrix>
Matrix ldlt_solve_matrix(const Matrix& a, const std::type_identity_t<Matrix>& b) {
  return a.ldlt().solve(b);
}

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
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

template class Cholesky<Eigen::Matrix2d>;
template class Cholesky<Eigen::Matrix3d>;
template class Cholesky<Matrix6>;
template class Cholesky<Eigen::Matrix<double, 21, 21>>;  // of the inertial state
template class Cholesky<Eigen::MatrixXd>;

template ColumnOf<Eigen::Matrix2d> ldlt_solve(const Eigen::Matrix2d&, const ColumnOf<Eigen::Matrix2d>&);
template ColumnOf<Eigen::Matrix3d> ldlt_solve(const Eigen::Matrix3d&, const ColumnOf<Eigen::Matrix3d>&);
template ColumnOf<Eigen::Matrix4d> ldlt_solve(const Eigen::Matrix4d&, const ColumnOf<Eigen::Matrix4d>&);
template ColumnOf<Matrix6> ldlt_solve(const Matrix6&, const ColumnOf<Matrix6>&);
template ColumnOf<SmallMatrix> ldlt_solve(const SmallMatrix&, const ColumnOf<SmallMatrix>&);
template ColumnOf<Eigen::MatrixXd> ldlt_solve(const Eigen::MatrixXd&, const ColumnOf<Eigen::MatrixXd>&);
template ColumnOf<Eigen::MatrixXcd> ldlt_solve(const Eigen::MatrixXcd&, const ColumnOf<Eigen::MatrixXcd>&);
template Eigen::Matrix2d ldlt_solve_matrix(const Eigen::Matrix2d&, const Eigen::Matrix2d&);
template Eigen::Matrix4d ldlt_solve_matrix(const Eigen::Matrix4d&, const Eigen::Matrix4d&);
template Matrix6 ldlt_solve_matrix(const Matrix6&, const Matrix6&);
template SmallMatrix ldlt_solve_matrix(const SmallMatrix&, const SmallMatrix&);
template std::optional<Eigen::Matrix3d> inverse_if_regular(const Eigen::Matrix3d&, double);
template std::optional<Matrix6> inverse_if_regular(const Matrix6&, double);

}  // namespace radioslam

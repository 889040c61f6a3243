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

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

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

}  // namespace radioslam

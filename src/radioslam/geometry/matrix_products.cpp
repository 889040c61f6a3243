#include <Eigen/LU>
#include <Eigen/QR>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime> congruence(const Jacobian& j,
                                                                                           const Matrix& p) {
  return j * p * j.transpose();
}

template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime> congruence(
    const Jacobian& j, const Matrix& p,
    const Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime>& q) {
  return j * p * j.transpose() + q;
}

template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::ColsAtCompileTime, Jacobian::ColsAtCompileTime> normal_matrix(
    const Jacobian& j, const Matrix& w) {
  return j.transpose() * w * j;
}

/// Eigen has formulas for sizes up to 4; larger ones it computes as matrices of any size, bit for bit.
template <class Matrix>
Matrix inverse(const Matrix& a) {
  if constexpr (Matrix::RowsAtCompileTime > 4)
    return inverse(Eigen::MatrixXd(a));
  else
    return a.inverse();
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(a).pseudoInverse();
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
template <int Rows, int Columns>
using Fixed = Eigen::Matrix<double, Rows, Columns>;

template Eigen::Matrix3d congruence(const Eigen::Matrix3d&, const Eigen::Matrix3d&);
template Matrix6 congruence(const Matrix6&, const Matrix6&);
template Eigen::Matrix3d congruence(const Fixed<3, 6>&, const Matrix6&, const Eigen::Matrix3d&);
template Matrix6 congruence(const Fixed<6, 12>&, const Fixed<12, 12>&, const Matrix6&);
template Eigen::Matrix3d congruence(const Eigen::Matrix3d&, const Eigen::Matrix3d&, const Eigen::Matrix3d&);
template Matrix6 congruence(const Matrix6&, const Matrix6&, const Matrix6&);
template Eigen::Matrix3d normal_matrix(const Eigen::Matrix3d&, const Eigen::Matrix3d&);
template Matrix6 normal_matrix(const Matrix6&, const Matrix6&);
template Eigen::Matrix2d inverse(const Eigen::Matrix2d&);
template Eigen::Matrix3d inverse(const Eigen::Matrix3d&);
template Matrix6 inverse(const Matrix6&);
template Matrix9 inverse(const Matrix9&);
template Eigen::MatrixXd inverse(const Eigen::MatrixXd&);
template Eigen::MatrixXcd inverse(const Eigen::MatrixXcd&);

}  // namespace radioslam

#include <Eigen/LU>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Matrix>
Matrix inverse(const Matrix& a) {
  return a.inverse();
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

template Eigen::Matrix2d inverse(const Eigen::Matrix2d&);
template Eigen::Matrix3d inverse(const Eigen::Matrix3d&);
template Matrix6 inverse(const Matrix6&);
template Matrix9 inverse(const Matrix9&);
template Eigen::MatrixXd inverse(const Eigen::MatrixXd&);
template Eigen::MatrixXcd inverse(const Eigen::MatrixXcd&);

}  // namespace radioslam

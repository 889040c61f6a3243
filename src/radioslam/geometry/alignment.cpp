#include "radioslam/geometry/alignment.hpp"

#include <Eigen/SVD>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

template <int D>
using Points = Eigen::Matrix<double, D, Eigen::Dynamic>;

template <int D>
struct Centred {
  Eigen::Matrix<double, D, 1> source_mean, target_mean;
  Eigen::Matrix<double, D, D> covariance;  ///< sum of w (target - mean)(source - mean)^T
};

template <int D>
Centred<D> centre(const Points<D>& source, const Points<D>& target, const Eigen::VectorXd& weights) {
  RADIOSLAM_CHECK(source.cols() == target.cols() && source.cols() > 0, "point sets must pair up");
  const Eigen::VectorXd w = weights.size() > 0 ? weights : Eigen::VectorXd::Ones(source.cols());
  Centred<D> c;
  c.source_mean = source * w / w.sum();
  c.target_mean = target * w / w.sum();
  c.covariance =
      (target.colwise() - c.target_mean) * w.asDiagonal() * (source.colwise() - c.source_mean).transpose();
  return c;
}

}  // namespace

SE2 align_points(const Eigen::Matrix2Xd& source, const Eigen::Matrix2Xd& target,
                 const Eigen::VectorXd& weights) {
  const auto c = centre<2>(source, target, weights);
  const double angle = std::atan2(c.covariance(1, 0) - c.covariance(0, 1), c.covariance.trace());
  const SE2 rotation(Eigen::Vector2d::Zero(), angle);
  return {c.target_mean - rotation.rotate(c.source_mean), angle};
}

SE3 align_points(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target,
                 const Eigen::VectorXd& weights) {
  const auto c = centre<3>(source, target, weights);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(c.covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  const Eigen::Matrix3d r = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return {c.target_mean - r * c.source_mean, Eigen::Quaterniond(r)};
}

}  // namespace radioslam

#include "radioslam/geometry/se3.hpp"

#include <cmath>

#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

/// Q of Barfoot (2017), eq. 7.86: the coupling block of the left Jacobian of SE(3).
Eigen::Matrix3d left_jacobian_coupling(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  double a = 0, b = 0, c = 0;
  if (t < 1e-2) {
    a = 1.0 / 6 - t2 / 120;
    b = 1.0 / 24 - t2 / 720;
    c = 1.0 / 120 - t2 / 2520;
  } else {
    const double s = std::sin(t), k = std::cos(t);
    a = (t - s) / (t2 * t);
    b = (t2 / 2 + k - 1) / (t2 * t2);
    c = 0.5 * (b + 3 * (t - s - t2 * t / 6) / (t2 * t2 * t));
  }
  const Eigen::Matrix3d r = skew(rho), p = skew(phi);
  const Eigen::Matrix3d pr = p * r, rp = r * p, prp = pr * p;
  return 0.5 * r + a * (pr + rp + prp) + b * (p * pr + rp * p - 3 * prp) + c * (prp * p + p * prp);
}

}  // namespace

SE3 SE3::exp(const Tangent& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return {so3_left_jacobian(phi) * xi.head<3>(), so3_exp(phi)};
}

SE3::Tangent SE3::log() const {
  const Eigen::Vector3d phi = so3_log(q_);
  Tangent xi;
  xi << so3_left_jacobian_inverse(phi) * t_, phi;
  return xi;
}

double SE3::yaw() const {
  const Eigen::Vector3d x = q_ * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x());
}

SE3 SE3::inverse() const {
  const Eigen::Quaterniond inverse = q_.conjugate();
  return {-(inverse * t_), inverse};
}

SE3::Jacobian SE3::adjoint() const {
  const Eigen::Matrix3d r = rotation_matrix();
  Jacobian ad = Jacobian::Zero();
  ad.topLeftCorner<3, 3>() = r;
  ad.topRightCorner<3, 3>() = skew(t_) * r;
  ad.bottomRightCorner<3, 3>() = r;
  return ad;
}

SE3::Jacobian SE3::right_jacobian(const Tangent& xi) {
  const Eigen::Vector3d rho = -xi.head<3>(), phi = -xi.tail<3>();
  Jacobian j = Jacobian::Zero();
  j.topLeftCorner<3, 3>() = so3_left_jacobian(phi);
  j.topRightCorner<3, 3>() = left_jacobian_coupling(rho, phi);
  j.bottomRightCorner<3, 3>() = j.topLeftCorner<3, 3>();
  return j;
}

SE3::Jacobian SE3::right_jacobian_inverse(const Tangent& xi) {
  const Eigen::Vector3d rho = -xi.head<3>(), phi = -xi.tail<3>();
  const Eigen::Matrix3d inverse = so3_left_jacobian_inverse(phi);
  Jacobian j = Jacobian::Zero();
  j.topLeftCorner<3, 3>() = inverse;
  j.topRightCorner<3, 3>() = -inverse * left_jacobian_coupling(rho, phi) * inverse;
  j.bottomRightCorner<3, 3>() = inverse;
  return j;
}

SE2 flatten(const SE3& pose) { return {pose.translation().head<2>(), pose.yaw()}; }

SE3 lift(const SE2& pose, double z_m) {
  return {Eigen::Vector3d(pose.translation().x(), pose.translation().y(), z_m),
          Eigen::Quaterniond(Eigen::AngleAxisd(pose.angle(), Eigen::Vector3d::UnitZ()))};
}

}  // namespace radioslam

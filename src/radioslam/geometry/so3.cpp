#include "radioslam/geometry/so3.hpp"

#include <cmath>

namespace radioslam {
namespace {

constexpr double kSmallAngle = 1e-3;  // below it the series to theta^4 is exact to double precision

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi) {
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  const double half_sinc = t < kSmallAngle ? 0.5 - t2 / 48 + t2 * t2 / 3840 : std::sin(t / 2) / t;
  Eigen::Quaterniond q(std::cos(t / 2), half_sinc * phi.x(), half_sinc * phi.y(), half_sinc * phi.z());
  q.normalize();
  return q;
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double w = sign * q.w();
  const Eigen::Vector3d v = sign * q.vec();
  const double n = v.norm();
  // theta / sin(theta / 2), from atan2 so that it holds for all angles up to pi.
  const double factor = n < kSmallAngle / 2 ? 2 / w * (1 - n * n / (3 * w * w)) : 2 * std::atan2(n, w) / n;
  return factor * v;
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return Eigen::Quaterniond::FromTwoVectors(a, b);
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi) {
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  const double a = t < kSmallAngle ? 0.5 - t2 / 24 : 2 * std::sin(t / 2) * std::sin(t / 2) / t2;
  const double b = t < kSmallAngle ? 1.0 / 6 - t2 / 120 : (t - std::sin(t)) / (t2 * t);
  const Eigen::Matrix3d x = skew(phi);
  return Eigen::Matrix3d::Identity() + a * x + b * x * x;
}

Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  const double c = t < kSmallAngle ? 1.0 / 12 + t2 / 720 : 1 / t2 - (1 + std::cos(t)) / (2 * t * std::sin(t));
  const Eigen::Matrix3d x = skew(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * x + c * x * x;
}

}  // namespace radioslam

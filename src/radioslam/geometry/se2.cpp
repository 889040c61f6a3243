#include "radioslam/geometry/se2.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kSmallTurn_rad = 1e-4;

/// sin(w)/w and (1 - cos w)/w, the entries of V in Exp: t = V * rho.
struct Sincs {
  double sinc, cosc;
};

Sincs sincs(double w) {
  if (std::abs(w) < kSmallTurn_rad) return {1 - w * w / 6, w / 2 - w * w * w / 24};
  const double half_sine = std::sin(w / 2);  // 1 - cos w = 2 sin^2(w/2), without cancellation
  return {std::sin(w) / w, 2 * half_sine * half_sine / w};
}

}  // namespace

double wrap_angle(double angle_rad) {
  constexpr double pi = std::numbers::pi;
  if (angle_rad > -pi && angle_rad <= pi) return angle_rad;
  // Within a turn and a half the difference is exact, as the remainder is, which takes ten times as long.
  constexpr double kExact = 9.42;
  if (angle_rad > pi && angle_rad < kExact) return angle_rad - 2 * pi;
  if (angle_rad < -pi && angle_rad > -kExact) return angle_rad + 2 * pi;
  const double wrapped = std::remainder(angle_rad, 2 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

SE2::SE2(const Point& translation, double angle_rad)
    : t_(translation), angle_(wrap_angle(angle_rad)), cosine_(std::cos(angle_)), sine_(std::sin(angle_)) {}

SE2 SE2::exp(const Tangent& xi) {
  const auto [s, c] = sincs(xi[2]);
  return {Point(s * xi[0] - c * xi[1], c * xi[0] + s * xi[1]), xi[2]};
}

SE2::Tangent SE2::log() const {
  // V^-1 = [a, w/2; -w/2, a] with a = (w/2) / tan(w/2).
  const double h = angle_ / 2;
  const double a = std::abs(angle_) < kSmallTurn_rad ? 1 - h * h / 3 : h / std::tan(h);
  return {a * t_.x() + h * t_.y(), -h * t_.x() + a * t_.y(), angle_};
}

SE2 SE2::inverse() const {
  SE2 result;
  result.t_ = {-cosine_ * t_.x() - sine_ * t_.y(), sine_ * t_.x() - cosine_ * t_.y()};
  result.angle_ = wrap_angle(-angle_);
  result.cosine_ = cosine_;
  result.sine_ = -sine_;
  return result;
}

SE2 SE2::operator*(const SE2& other) const { return {*this * other.t_, angle_ + other.angle_}; }

SE2::Jacobian SE2::adjoint() const {
  Jacobian ad = Jacobian::Identity();
  ad.topLeftCorner<2, 2>() = rotation_matrix();
  ad(0, 2) = t_.y();
  ad(1, 2) = -t_.x();
  return ad;
}

SE2::Jacobian SE2::right_jacobian(const Tangent& xi) {
  // Solà, Deray, Atchuthan, A micro Lie theory, eq. 163.
  const double w = xi[2];
  const auto [s, c] = sincs(w);
  Jacobian j = Jacobian::Identity();
  j(0, 0) = s;
  j(0, 1) = c;
  j(1, 0) = -c;
  j(1, 1) = s;
  double p = 0, q = 0;  // (w - sin w)/w^2 and (1 - cos w)/w^2
  if (std::abs(w) < kSmallTurn_rad) {
    p = w / 6;
    q = 0.5 - w * w / 24;
  } else {
    p = (w - std::sin(w)) / (w * w);
    q = c / w;
  }
  j(0, 2) = p * xi[0] - q * xi[1];
  j(1, 2) = q * xi[0] + p * xi[1];
  return j;
}

SE2::Jacobian SE2::right_jacobian_inverse(const Tangent& xi) {
  const Jacobian j = right_jacobian(xi);
  const Eigen::Matrix2d upper = j.topLeftCorner<2, 2>();
  const double det = upper.determinant();
  Eigen::Matrix2d upper_inverse;
  upper_inverse << upper(1, 1), -upper(0, 1), -upper(1, 0), upper(0, 0);
  upper_inverse /= det;
  Jacobian inverse = Jacobian::Identity();
  inverse.topLeftCorner<2, 2>() = upper_inverse;
  inverse.topRightCorner<2, 1>() = -upper_inverse * j.topRightCorner<2, 1>();
  return inverse;
}

}  // namespace radioslam

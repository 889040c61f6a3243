// Poses in the plane. T_a_b takes points of frame b to frame a: p_a = T_a_b * p_b.
// Tangent = [translation x, y; rotation], perturbation on the right: T * Exp(xi).
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// Wraps an angle to (-pi, pi].
double wrap_angle(double angle_rad);

/// A rigid motion of the plane; metres and radians. Keeps the cosine and sine of its angle, since points are
/// moved and motions inverted more often than motions are made.
class SE2 {
 public:
  static constexpr int kDim = 2;  ///< of the points it moves
  static constexpr int kDof = 3;
  using Tangent = Eigen::Matrix<double, kDof, 1>;
  using Jacobian = Eigen::Matrix<double, kDof, kDof>;
  using Point = Eigen::Vector2d;

  SE2() = default;
  SE2(const Point& translation, double angle_rad);

  static SE2 exp(const Tangent& xi);
  Tangent log() const;

  const Point& translation() const { return t_; }
  double angle() const { return angle_; }
  Eigen::Matrix2d rotation_matrix() const {
    return (Eigen::Matrix2d() << cosine_, -sine_, sine_, cosine_).finished();
  }

  SE2 inverse() const;
  SE2 operator*(const SE2& other) const;
  Point operator*(const Point& p) const { return t_ + rotate(p); }
  Point rotate(const Point& p) const {
    return {cosine_ * p.x() - sine_ * p.y(), sine_ * p.x() + cosine_ * p.y()};
  }

  /// Ad(T): T Exp(xi) T^-1 = Exp(Ad(T) xi).
  Jacobian adjoint() const;
  /// Log(Exp(xi) Exp(d)) = xi + right_jacobian_inverse(xi) d to first order.
  static Jacobian right_jacobian(const Tangent& xi);
  static Jacobian right_jacobian_inverse(const Tangent& xi);

 private:
  Point t_ = Point::Zero();
  double angle_ = 0, cosine_ = 1, sine_ = 0;
};

}  // namespace radioslam

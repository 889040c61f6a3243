// Poses in space. T_a_b takes points of frame b to frame a: p_a = T_a_b * p_b.
// Tangent = [translation; rotation], perturbation on the right: T * Exp(xi).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// A rigid motion of space; metres, unit quaternion.
class SE3 {
 public:
  static constexpr int kDim = 3;  ///< of the points it moves
  static constexpr int kDof = 6;
  using Tangent = Eigen::Matrix<double, kDof, 1>;
  using Jacobian = Eigen::Matrix<double, kDof, kDof>;
  using Point = Eigen::Vector3d;

  SE3() = default;
  /// `rotation` is normalised.
  SE3(const Point& translation, const Eigen::Quaterniond& rotation)
      : t_(translation), q_(rotation.normalized()) {}

  static SE3 exp(const Tangent& xi);
  Tangent log() const;

  const Point& translation() const { return t_; }
  const Eigen::Quaterniond& rotation() const { return q_; }
  Eigen::Matrix3d rotation_matrix() const { return q_.toRotationMatrix(); }
  /// Heading of body x in the xy-plane, counter-clockwise from x.
  double yaw() const;

  SE3 inverse() const;
  SE3 operator*(const SE3& other) const { return {t_ + q_ * other.t_, q_ * other.q_}; }
  Point operator*(const Point& p) const { return t_ + q_ * p; }
  Point rotate(const Point& p) const { return q_ * p; }

  /// Ad(T): T Exp(xi) T^-1 = Exp(Ad(T) xi), [R, [t]x R; 0, R].
  Jacobian adjoint() const;
  /// Log(Exp(xi) Exp(d)) = xi + right_jacobian_inverse(xi) d to first order.
  static Jacobian right_jacobian(const Tangent& xi);
  static Jacobian right_jacobian_inverse(const Tangent& xi);

 private:
  Point t_ = Point::Zero();
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
};

/// The pose seen from above: x, y and yaw.
SE2 flatten(const SE3& pose);
/// The plane's pose at height z, without roll or pitch.
SE3 lift(const SE2& pose, double z_m = 0);

/// The pose as the estimate's dimension sees it: itself, or from above.
template <class Pose>
Pose pose_as(const SE3& pose);
template <>
inline SE2 pose_as<SE2>(const SE3& pose) {
  return flatten(pose);
}
template <>
inline SE3 pose_as<SE3>(const SE3& pose) {
  return pose;
}

/// Covariance of a pose's error, of its x, y and yaw where the estimate's dimension sees it from above.
template <class Pose>
typename Pose::Jacobian covariance_as(const SE3::Jacobian& covariance) {
  if constexpr (Pose::kDim == 3) {
    return covariance;
  } else {
    const std::array<int, 3> kept{0, 1, 5};  // x, y, yaw
    return covariance(kept, kept);
  }
}

/// And back: a pose of the plane keeps `z_m`.
inline SE3 as_se3(const SE2& pose, double z_m) { return lift(pose, z_m); }
inline SE3 as_se3(const SE3& pose, double /*z_m*/) { return pose; }

}  // namespace radioslam

// Rotations in space: exponential, logarithm and their Jacobians.
// Source: Barfoot, State Estimation for Robotics, chapter 7; series near zero keep full precision.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace radioslam {

/// [v]x, so that skew(v) * w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Exp: rotation vector (radians) to unit quaternion.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi);
/// Log: unit quaternion to the rotation vector of length at most pi.
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);

/// The smallest rotation that turns the direction of `a` into that of `b`.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Left Jacobian: Exp(phi + d) = Exp(J_l(phi) d) Exp(phi) to first order. The right one is J_l(-phi).
Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi);
Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& phi);

}  // namespace radioslam

// A pose with its covariance, for T Exp(xi): what chains of measured poses add up to, to first order.
#pragma once

#include <Eigen/Core>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

template <class Pose>
struct UncertainPose {
  Pose pose;
  typename Pose::Jacobian covariance = Pose::Jacobian::Zero();

  /// T^-1, whose perturbation is -Ad(T) xi.
  UncertainPose inverse() const {
    const typename Pose::Jacobian carry = pose.adjoint();
    return {pose.inverse(), congruence(carry, covariance)};
  }

  /// Of two independent ones: T Exp(xi) S Exp(zeta) = T S Exp(Ad(S^-1) xi) Exp(zeta).
  UncertainPose operator*(const UncertainPose& next) const {
    const typename Pose::Jacobian carry = next.pose.inverse().adjoint();
    return {pose * next.pose, congruence(carry, covariance, next.covariance)};
  }

  /// Of the pose's position, in the frame that it leads to.
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> position_covariance() const {
    const auto turn = pose.rotation_matrix();
    return turn * covariance.template topLeftCorner<Pose::kDim, Pose::kDim>() * turn.transpose();
  }
};

/// A covariance, or an information, that is the same about all axes of [translation; rotation].
inline SE3::Jacobian isotropic(double translation, double rotation) {
  SE3::Jacobian matrix = SE3::Jacobian::Zero();
  matrix.diagonal().head<3>().setConstant(translation);
  matrix.diagonal().tail<3>().setConstant(rotation);
  return matrix;
}

}  // namespace radioslam

// State of LiDAR-inertial estimation: pose, velocity, IMU biases, and the pose of the world on the map.
//
// The world's z points up; the map is the one that poses are measured on, by scan matching for example.
// Tangent of a state, 21 numbers, in this order:
//   [translation, rotation of T_world_body Exp(xi) (m, rad); velocity (m/s); bias of the gyroscope (rad/s);
//    bias of the accelerometer (m/s^2); translation, rotation of T_map_world Exp(xi)]
#pragma once

#include <Eigen/Core>

#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// Measured minus true.
struct InertialBias {
  Eigen::Vector3d gyroscope_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_mps2 = Eigen::Vector3d::Zero();
};

struct InertialState {
  static constexpr int kDof = 21;
  static constexpr int kVelocity = 6, kGyroscope = 9, kAccelerometer = 12, kMap = 15;  ///< tangent offsets
  using Tangent = Eigen::Matrix<double, kDof, 1>;
  using Jacobian = Eigen::Matrix<double, kDof, kDof>;

  SE3 T_world_body;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< of the body's origin, in the world
  InertialBias bias;
  SE3 T_map_world = {};

  InertialState moved_by(const Tangent& step) const;
  /// Inverse of moved_by: the step from this state to `there`.
  Tangent step_to(const InertialState& there) const;
};

}  // namespace radioslam

// IMU samples of a robot.
#pragma once

#include <Eigen/Core>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// IMU sample in the robot's body frame; the sensor is at the body's origin.
struct ImuSample {
  Stamp stamp;
  /// Acceleration minus gravity: (0, 0, +9.81) at rest and level.
  Eigen::Vector3d specific_force_mps2;
  Eigen::Vector3d angular_rate_radps;
};

}  // namespace radioslam

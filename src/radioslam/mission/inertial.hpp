// What a robot's inertial measurement unit recorded.
#pragma once

#include <Eigen/Core>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One reading, in the robot's body frame, of a unit at the body's origin.
struct InertialSample {
  Stamp stamp;
  /// Acceleration less gravity's: a unit that lies still and level reads (0, 0, +9.81).
  Eigen::Vector3d specific_force_mps2;
  Eigen::Vector3d angular_rate_radps;
};

}  // namespace radioslam

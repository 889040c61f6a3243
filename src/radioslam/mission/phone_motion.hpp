// What the motion sensors of a hand-held phone recorded, in Android's device frame: x to the right, y to the
// top of the screen, z out of the screen.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One reading of a three-axis sensor in the device frame.
struct VectorSample {
  Stamp stamp;
  Eigen::Vector3d value;
};

/// One fused orientation: R_enu_device, with ENU = x east, y (magnetic) north, z up.
struct OrientationSample {
  Stamp stamp;
  Eigen::Quaterniond R_enu_device;
};

/// The sensors' readings, each in time order (equal stamps may follow each other).
struct PhoneMotion {
  std::vector<VectorSample> specific_force_mps2;  ///< accelerometer: at rest it points up, 9.81
  std::vector<VectorSample> angular_rate_radps;   ///< gyroscope
  std::vector<OrientationSample> orientation;     ///< rotation vector; may be empty
};

}  // namespace radioslam

// Motion sensor recordings of a hand-held phone, in Android's device frame: x to the right, y to the top of
// the screen, z out of the screen.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Sample of a three-axis sensor in the device frame.
struct VectorSample {
  Stamp stamp;
  Eigen::Vector3d value;
};

/// Fused orientation R_enu_device, with ENU = x east, y (magnetic) north, z up.
struct OrientationSample {
  Stamp stamp;
  Eigen::Quaterniond R_enu_device;
};

/// Samples of all sensors, each in time order; equal stamps are allowed.
struct PhoneMotion {
  std::vector<VectorSample> specific_force_mps2;  ///< accelerometer: at rest 9.81, pointing up
  std::vector<VectorSample> angular_rate_radps;   ///< gyroscope
  std::vector<OrientationSample> orientation;     ///< rotation vector; may be empty
};

}  // namespace radioslam

// Poses and directions as seen from above; in the plane they are what they are.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

// The normal density without its factor, as a term of mixtures with outliers.

/// exp(-squared_norm / 2), or zero where that vanishes beside any probability of an outlier.
inline double unit_normal(double squared_norm) {
  constexpr double kVanishes = 80;
  return squared_norm > kVanishes ? 0 : std::exp(-0.5 * squared_norm);
}

inline SE2 seen_from_above(const SE2& pose) { return pose; }
inline SE2 seen_from_above(const SE3& pose) { return flatten(pose); }

/// Azimuth, in the receiver's levelled body frame, of a direction in its body frame.
inline double level_azimuth(const SE2& /*receiver*/, const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}
inline double level_azimuth(const SE3& receiver, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d level = receiver.rotation() * direction;
  return std::atan2(level.y(), level.x()) - receiver.yaw();
}

}  // namespace radioslam

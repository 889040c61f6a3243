// Directions as azimuth and elevation.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace radioslam {

/// The unit vector at an azimuth, counter-clockwise from x, and an elevation, up from the xy-plane.
inline Eigen::Vector3d unit_direction(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

}  // namespace radioslam

// Grid of wave sources over which profiles are computed: azimuth x elevation x wavefront curvature.
#pragma once

#include <numbers>
#include <vector>

#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam {

struct WaveGrid {
  int azimuths = 360;  ///< evenly spaced, from -pi
  std::vector<double> elevations_rad{0};
  std::vector<double> curvatures_per_m{0};

  double azimuth_rad(int k) const { return -std::numbers::pi + 2 * std::numbers::pi * k / azimuths; }
  std::size_t size() const {
    return static_cast<std::size_t>(azimuths) * elevations_rad.size() * curvatures_per_m.size();
  }
  /// Index order is elevation, curvature, azimuth; azimuth varies fastest.
  WaveSource source(std::size_t index) const {
    const auto around = static_cast<std::size_t>(azimuths);
    const std::size_t row = index / around;
    return {azimuth_rad(static_cast<int>(index % around)), elevations_rad[row / curvatures_per_m.size()],
            curvatures_per_m[row % curvatures_per_m.size()]};
  }
};

}  // namespace radioslam

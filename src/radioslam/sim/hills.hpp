// Gentle ground: a height over the plane as a sum of waves, and how a vehicle stands on it.
//
//   h(p) = sum over waves of amplitude sin(k . p + phase), wavelengths of 150 to 500 m
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

class Hills {
 public:
  /// The plane z = 0.
  Hills() = default;
  /// Ground whose height has the standard deviation `sigma_height_m`.
  Hills(double sigma_height_m, Rng rng);

  double height_m(const Eigen::Vector2d& position) const;
  Eigen::Vector2d gradient(const Eigen::Vector2d& position) const;
  /// The body on the ground: z along the ground's normal, x above the plane's heading.
  SE3 stand(const SE2& T_floor_body) const;

 private:
  struct Wave {
    double amplitude_m = 0;
    Eigen::Vector2d wavenumber_per_m;
    double phase_rad = 0;
  };
  std::vector<Wave> waves_;
};

}  // namespace radioslam

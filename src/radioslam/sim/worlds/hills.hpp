// Hilly ground: height as a sum of waves, the pose of a vehicle on it, and its intersection with rays.
//
//   h(p) = sum over waves of amplitude sin(k . p + phase), wavelengths of 150 to 500 m
//
// The curvature of a ray's height above the ground, f(s), is at most M = sum of amplitude (k . d)^2 along d.
// So f stays positive over a step s that solves f + f' s - M s^2 / 2 = 0: such steps never pass the ground,
// and close to it they are Newton steps.
#pragma once

#include <Eigen/Core>
#include <optional>
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
  /// Pose of a body on the ground: z along the ground's normal, x above the plane's heading.
  SE3 pose_on_ground(const SE2& T_floor_body) const;
  /// Distance along a unit vector from a point above the ground to its first intersection with the ground, to
  /// a micrometre of height. Nothing beyond `max_m` or from below the ground.
  std::optional<double> ray_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double max_m) const;

 private:
  struct Wave {
    double amplitude_m = 0;
    Eigen::Vector2d wavenumber_per_m;
    double phase_rad = 0;
  };
  double max_curvature_per_m(const Eigen::Vector2d& direction) const;

  std::vector<Wave> waves_;
};

}  // namespace radioslam

// True motion of a robot: pose at any time, along given poses or on a smooth curve.
//
// Between given poses the motion is geodesic, so velocities jump at each pose. Accelerations, as inertial
// units measure them, are only defined on the smooth curve.
#pragma once

#include <variant>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/motion/spline_motion.hpp"

namespace radioslam {

class TrueMotion {
 public:
  /// Along T_common_body, at least one pose, the first at time 0 or before.
  explicit TrueMotion(Trajectory<SE3> poses);
  explicit TrueMotion(SplineMotion curve);

  /// End of the motion, which begins at time 0.
  Stamp end() const;
  /// T_common_body at a time clamped to [0, end].
  SE3 pose_at(Stamp stamp) const;
  bool smooth() const { return std::holds_alternative<SplineMotion>(motion_); }
  /// On a smooth curve only.
  MotionState state_at(Stamp stamp) const;
  /// Poses from time 0 to the end.
  Trajectory<SE3> poses(double rate_hz) const;

 private:
  std::variant<Trajectory<SE3>, SplineMotion> motion_;
};

}  // namespace radioslam

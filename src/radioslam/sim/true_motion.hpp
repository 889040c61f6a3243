// Where a robot truly is at any time: along poses that are given, or on a smooth curve.
//
// Between given poses it moves on the geodesic, so its velocity jumps at each of them: good enough for
// whoever asks where it is. An inertial unit asks for accelerations, which only the smooth curve has.
#pragma once

#include <variant>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/spline_motion.hpp"

namespace radioslam {

class TrueMotion {
 public:
  /// Along T_common_body, at least one pose, the first at time 0 or before.
  explicit TrueMotion(Trajectory<SE3> poses);
  explicit TrueMotion(SplineMotion curve);

  /// From time 0 to here.
  Stamp end() const;
  /// T_common_body at a time from 0 to the end; clamped to them.
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

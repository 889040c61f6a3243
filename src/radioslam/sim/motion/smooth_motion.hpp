// Smooth motion along given poses for simulated inertial units: starts from rest, with continuous
// accelerations.
//
// The poses are passed in order, at a time tau that is constant at first, accelerates for `accelerate_s`
// (tau' = 3 x^2 - 2 x^3), and then varies about unit rate:
//   tau = rho + sum of a_j (sin(w_j rho + c_j) - sin c_j),   sum of a_j w_j = speed_swing,
// rho being tau without the variation. The body rolls and pitches slightly while it moves. A spline
// (spline_motion.hpp) with one control per `knot_s` rounds the corners of the poses: it passes them within
// about acceleration knot_s^2 / 6. It ends two knots before the poses do, still moving.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/motion/spline_motion.hpp"

namespace radioslam {

struct SmoothMotionParams {
  double rest_s = 2;
  double accelerate_s = 2;
  double speed_swing = 0;
  double sway_rad = 0;
  double knot_s = 0.25;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(rest_s, "s", 0, 1000, "time at rest at the start, for robots with an inertial unit");
    RADIOSLAM_FIELD(accelerate_s, "s", 0.1, 1000,
                    "duration of the acceleration to full speed, for robots with an inertial unit");
    RADIOSLAM_FIELD(speed_swing, "", 0, 0.9,
                    "largest relative variation of the speed, for robots with an inertial unit");
    RADIOSLAM_FIELD(sway_rad, "rad", 0, 0.2,
                    "standard deviation of roll and pitch while moving, for robots with an inertial unit");
    RADIOSLAM_FIELD(knot_s, "s", 0.01, 2,
                    "knot interval of the spline that smooths the motion; higher values cut corners more");
  }
};

/// Along poses T_common_body, at least one, the first at time 0.
SplineMotion smooth_motion(const Trajectory<SE3>& poses, const SmoothMotionParams& params, const Rng& rng);

}  // namespace radioslam

// A ride along given poses as a vehicle with an inertial unit would make it: from rest, without jerks.
//
// The poses are passed in their order at a time tau of their own, which stands still at first, takes up speed
// over `accelerate_s` (tau' = 3 x^2 - 2 x^3) and then swings about 1,
//   tau = rho + sum of a_j (sin(w_j rho + c_j) - sin c_j),   sum of a_j w_j = speed_swing,
// rho being tau without the swings. The body rolls and pitches a little while it moves. A spline
// (spline_motion.hpp) with controls every `knot_s` along that cuts the corners that poses have: it passes
// within about acceleration knot_s^2 / 6 of them. It ends two knots before the poses do, still moving.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/spline_motion.hpp"

namespace radioslam {

struct SmoothRideParams {
  double rest_s = 2;
  double accelerate_s = 2;
  double speed_swing = 0;
  double sway_rad = 0;
  double knot_s = 0.25;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"rest_s", "s", 0, 1000, "with an inertial unit, robots stand so long at the start"},
          self.rest_s);
    visit(Field{"accelerate_s", "s", 0.1, 1000, "and then take up speed over so long"}, self.accelerate_s);
    visit(Field{"speed_swing", "", 0, 0.9, "their speed swings by at most this share"}, self.speed_swing);
    visit(Field{"sway_rad", "rad", 0, 0.2, "standard deviation of their roll and pitch while they move"},
          self.sway_rad);
    visit(Field{"knot_s", "s", 0.01, 2, "between the knots of the spline that smooths their motion"},
          self.knot_s);
  }
};

/// Along poses T_common_body, at least one, the first at time 0.
SplineMotion smooth_ride(const Trajectory<SE3>& way, const SmoothRideParams& params, const Rng& rng);

}  // namespace radioslam

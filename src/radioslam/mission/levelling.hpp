// A phone's motion in a frame that is level but knows no north: heading from the gyroscope, vertical
// acceleration from the accelerometer.
//
//   R <- R Exp(w dt)                       gyroscope, device to level frame
//   R <- Exp(dt/tau (a_level/|a| x z)) R   leans the measured up towards z (Mahony et al. 2008, proportional)
//
// The correction's axis is horizontal, so it does not turn the heading. The heading is the direction of the
// device's y axis seen from above, counter-clockwise from the level frame's x; it starts at 0.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

struct LevellingParams {
  double gravity_time_s = 3;   ///< tau: slow against steps (0.5 s), fast against drift (minutes)
  double gravity_start_s = 1;  ///< two steps, whose accelerations about cancel

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"gravity_time_s", "s", 0.1, 100, "time in which the accelerometer corrects the tilt"},
          self.gravity_time_s);
    visit(Field{"gravity_start_s", "s", 0.02, 60, "first readings averaged for the tilt at the start"},
          self.gravity_start_s);
  }
};

/// At one stamp of the gyroscope.
struct LevelSample {
  Stamp stamp;
  double heading_rad = 0;    ///< since the start, not wrapped
  double vertical_mps2 = 0;  ///< upward acceleration, gravity taken off
};

/// One sample per angular rate; needs at least one reading of both sensors (else the result is empty).
std::vector<LevelSample> level_motion(const PhoneMotion& motion, const LevellingParams& params);

}  // namespace radioslam

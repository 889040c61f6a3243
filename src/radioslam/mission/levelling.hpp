// Levels a phone's motion: heading from the gyroscope and vertical acceleration from the accelerometer, in a
// gravity-aligned frame with arbitrary north.
//
//   R <- R Exp(w dt)                       gyroscope, device to level frame
//   R <- Exp(dt/tau (a_level/|a| x z)) R   tilts the measured up towards z (Mahony et al. 2008, proportional)
//
// The axis of the correction is horizontal, so it does not change the heading. The heading is the direction
// of the device's y axis seen from above, counter-clockwise from the level frame's x; it starts at 0.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

struct LevellingParams {
  double gravity_time_s = 3;   ///< tau: slow against steps (0.5 s), fast against drift (minutes)
  double gravity_start_s = 1;  ///< two steps, whose accelerations roughly cancel

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(gravity_time_s, "s", 0.1, 100,
                    "time constant of the tilt correction by the accelerometer; higher values suppress step "
                    "accelerations");
    RADIOSLAM_FIELD(gravity_start_s, "s", 0.02, 60,
                    "duration of the first accelerometer samples averaged for the initial tilt");
  }
};

/// Levelled motion at one gyroscope stamp.
struct LevelSample {
  Stamp stamp;
  double heading_rad = 0;    ///< since the start, not wrapped
  double vertical_mps2 = 0;  ///< upward acceleration without gravity
};

/// One sample per angular rate; empty unless both sensors have at least one sample.
std::vector<LevelSample> level_motion(const PhoneMotion& motion, const LevellingParams& params);

}  // namespace radioslam

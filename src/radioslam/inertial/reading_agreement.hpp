// Whether inertial readings can be of the body whose poses something else measured (laser scans, say), before
// they are used: another unit of measure, another mounting and another clock show without any estimate.
//
//   accelerometer   median length of its mean over `force_window_s`, against gravity's
//   turns           of poses and gyroscope over windows of `window_s`: s, g; bias b = median (g - s) / t
//                     r = g - s - b t,  sigma^2 = 2 turn^2 + (share |s|)^2
//                     b within its stated sigma times `sigmas`; median |r|^2 / (3 sigma^2) <= sigmas^2 over
//                     the windows in which either turns by more than its sigmas
//   clock           lag that the sum of min(|r|^2 / sigma^2, sigmas^2) is least at, where that is less than
//                   half of what it is without
// Scans that are wrong now and then do not move medians; a drive that hardly turns tells nothing of turns.
// Cost: readings times lags.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/inertial/inertial_noise.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

struct ReadingAgreementParams {
  double window_s = 0.5;
  double force_window_s = 1;
  double sigma_turn_rad = 0.02;
  double sigma_turn_share = 0.1;
  double sigmas = 5;
  int least_turns = 5;
  double largest_gravity_error_mps2 = 1;
  double longest_lag_s = 1;
  double lag_step_s = 0.05;
  double harmless_lag_s = 0.1;
  double harmless_lag_steps = 0.75;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"window_s", "s", 0.01, 100, "over which turns are compared"}, self.window_s);
    visit(Field{"force_window_s", "s", 0.01, 100, "over which forces are averaged"}, self.force_window_s);
    visit(Field{"sigma_turn_rad", "rad", 1e-4, 1, "error of the heading of a pose"}, self.sigma_turn_rad);
    visit(Field{"sigma_turn_share", "", 0, 1, "error of a turn, of its angle"}, self.sigma_turn_share);
    visit(Field{"sigmas", "", 1, 1000, "allowed, of errors and of the gyroscope's bias"}, self.sigmas);
    visit(Field{"least_turns", "", 1, 1e6, "windows with a turn that it takes to judge the gyroscope"},
          self.least_turns);
    visit(Field{"largest_gravity_error_mps2", "m/s^2", 0.01, 100, "of the mean force's length"},
          self.largest_gravity_error_mps2);
    visit(Field{"longest_lag_s", "s", 0, 60, "looked for between the clocks"}, self.longest_lag_s);
    visit(Field{"lag_step_s", "s", 1e-3, 10, "from one lag to the next"}, self.lag_step_s);
    visit(Field{"harmless_lag_s", "s", 0, 60, "that is let pass"}, self.harmless_lag_s);
    visit(Field{"harmless_lag_steps", "", 0, 100, "or so many times the time from pose to pose"},
          self.harmless_lag_steps);
  }
};

/// What the readings contradict, in words that follow a robot's name; nothing where they may be used.
std::optional<std::string> disagreement(const Trajectory<SE3>& poses,
                                        const std::vector<InertialSample>& samples,
                                        const InertialNoiseParams& noise,
                                        const ReadingAgreementParams& params);

}  // namespace radioslam

// Footsteps in a phone's vertical acceleration, and how long they are.
//
// The vertical acceleration is band-passed (difference of two Gaussian averages: one takes off the jitter of
// the heel strike, one the slow rest of gravity). A step is a peak that rises above a share of the signal's
// local root mean square and above a floor, at least `shortest_step_s` after the last one; of peaks closer
// than that the highest counts. A step lasts from the peak before it, if that is not more than
// `longest_step_s` ago, else from one usual step before its own peak.
// Length: Weinberg 2002, Using the ADXL202 in pedometer and personal navigation applications (AN-602):
// K (a_max - a_min)^(1/4) over the step.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/levelling.hpp"

namespace radioslam {

struct StepParams {
  double smooth_s = 0.06;          ///< sigma of the short average: half the power at 2.2 Hz
  double detrend_s = 0.4;          ///< sigma of the long average: half the power at 0.33 Hz
  double rms_window_s = 2;         ///< some four steps
  double peak_share_of_rms = 0.5;  ///< a sine's peak is at 1.4
  double peak_floor_mps2 = 0.8;    ///< strolling peaks at 1 to 2 m/s^2, a phone in a still hand below 0.3
  double shortest_step_s = 0.35;   ///< 170 steps per minute: a brisk walk has 140
  double usual_step_s = 0.55;      ///< 110 steps per minute
  double longest_step_s = 1;       ///< slower is standing
  double weinberg_k = 0.4;         ///< 0.4 to 0.5 in the literature; indoor strolling is at the short end

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"smooth_s", "s", 0.001, 1, "sigma of the average that takes off jitter"}, self.smooth_s);
    visit(Field{"detrend_s", "s", 0.01, 10, "sigma of the average that is taken off"}, self.detrend_s);
    visit(Field{"rms_window_s", "s", 0.1, 100, "sigma of the window of the local root mean square"},
          self.rms_window_s);
    visit(Field{"peak_share_of_rms", "", 0, 5, "a peak is higher than this share of the local rms"},
          self.peak_share_of_rms);
    visit(Field{"peak_floor_mps2", "m/s^2", 0, 20, "and than this"}, self.peak_floor_mps2);
    visit(Field{"shortest_step_s", "s", 0.05, 2, "no step follows another sooner"}, self.shortest_step_s);
    visit(Field{"usual_step_s", "s", 0.05, 2, "length of a first step"}, self.usual_step_s);
    visit(Field{"longest_step_s", "s", 0.1, 5, "after a longer pause a step counts as a first one"},
          self.longest_step_s);
    visit(Field{"weinberg_k", "", 0.1, 1, "step length = K (a_max - a_min)^(1/4)"}, self.weinberg_k);
  }
};

/// One step, in time and length.
struct Step {
  Stamp begin, end;
  double length_m = 0;
};

/// The walk's steps, in time order, none overlapping.
std::vector<Step> find_steps(const std::vector<LevelSample>& motion, const StepParams& params);

}  // namespace radioslam

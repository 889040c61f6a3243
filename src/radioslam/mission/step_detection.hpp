// Step detection and step length from a phone's vertical acceleration.
//
// The vertical acceleration is band-pass filtered (difference of two Gaussian averages: one removes the
// jitter of heel strikes, the other residual gravity). A step is a peak above both a fraction of the signal's
// local root mean square and a floor, at least `min_step_s` after the previous one; of closer peaks the
// highest counts. A step lasts from the previous peak if that is at most `max_step_s` ago, else from
// `nominal_step_s` before its own peak. Length: Weinberg 2002, Using the ADXL202 in pedometer and personal
// navigation applications (AN-602): K (a_max - a_min)^(1/4) over the step.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/levelling.hpp"

namespace radioslam {

struct StepParams {
  double smooth_s = 0.06;        ///< half the power at 2.2 Hz
  double detrend_s = 0.4;        ///< half the power at 0.33 Hz
  double rms_window_s = 2;       ///< about four steps
  double peak_rms_ratio = 0.5;   ///< the peak of a sine is at 1.4
  double peak_floor_mps2 = 0.8;  ///< slow walking: 1 to 2 m/s^2; a phone held still: below 0.3
  double min_step_s = 0.35;      ///< 170 steps per minute: a brisk walk has 140
  double nominal_step_s = 0.55;  ///< 110 steps per minute
  double max_step_s = 1;         ///< anything slower is a pause
  double weinberg_k = 0.4;       ///< 0.4 to 0.5 in the literature; slow indoor walking is at the low end

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(smooth_s, "s", 0.001, 1,
                    "standard deviation of the Gaussian average that smooths the vertical acceleration");
    RADIOSLAM_FIELD(detrend_s, "s", 0.01, 10,
                    "standard deviation of the Gaussian average subtracted from the vertical acceleration");
    RADIOSLAM_FIELD(
        rms_window_s, "s", 0.1, 100,
        "standard deviation of the window of the local root mean square of vertical acceleration");
    RADIOSLAM_FIELD(peak_rms_ratio, "", 0, 5,
                    "smallest height of a step's peak relative to the local root mean square; higher values "
                    "find fewer steps");
    RADIOSLAM_FIELD(peak_floor_mps2, "m/s^2", 0, 20,
                    "smallest height of a step's peak; higher values find fewer steps");
    RADIOSLAM_FIELD(min_step_s, "s", 0.05, 2, "shortest time between two steps");
    RADIOSLAM_FIELD(nominal_step_s, "s", 0.05, 2, "assumed duration of the first step after a pause");
    RADIOSLAM_FIELD(
        max_step_s, "s", 0.1, 5,
        "longest time between consecutive steps; after a longer pause a step counts as the first");
    RADIOSLAM_FIELD(weinberg_k, "", 0.1, 1, "factor K of the step length K (a_max - a_min)^(1/4)");
  }
};

/// Time interval and length of one step.
struct Step {
  Stamp begin, end;
  double length_m = 0;
};

/// Detected steps, in time order, not overlapping.
std::vector<Step> find_steps(const std::vector<LevelSample>& motion, const StepParams& params);

}  // namespace radioslam

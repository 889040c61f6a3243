// Pedestrian dead reckoning: a walker's trajectory from the motion sensors of a hand-held phone.
//
//   levelling   heading from the gyroscope, vertical acceleration
//   steps       time and length of every step
//   compass     direction of east
//   p <- p + length (cos, sin)(heading)     each step points along its mean heading
//
// The phone is held in front of the body with its screen up or towards the walker and its y axis in the
// direction of walking. Body frame of the odometry: x forward, z up; yaw counter-clockwise from the frame's x
// axis, which is east if the phone recorded its orientation and the initial heading otherwise. Rotating the
// phone in the hand rotates the path; a turn on the spot appears in the yaw of the next step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

// Levels a phone's motion: heading from the gyroscope and vertical acceleration from the accelerometer, in a
// gravity-aligned frame with arbitrary north.
//
//   R <- R Exp(w dt)                       gyroscope, device to level frame
//   R <- Exp(dt/tau (a_level/|a| x z)) R   tilts the measured up towards z (Mahony et al. 2008, proportional)
//
// The axis of the correction is horizontal, so it does not change the heading. The heading is the direction
// of the device's y axis seen from above, counter-clockwise from the level frame's x; it starts at 0.

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

// Estimates the offset from a gyroscope heading to east from the phone's fused orientation.
//
// The fused heading relies on a magnetometer, which steel disturbs over metres; the gyroscope's heading is
// smooth but has an arbitrary origin and drifts. Their difference over a recording is offset + drift (t -
// middle), fitted robustly (Cauchy weights, iterated). The drift has a prior, since a short walk past steel
// does not constrain it.

struct CompassParams {
  double cauchy_scale_rad = 0.1;
  double independent_s = 5;          ///< about 5 m of walking: the extent of one disturbance
  double sigma_heading_rad = 0.2;    ///< typical indoors
  double sigma_drift_radps = 0.001;  ///< 0.06 degrees per second

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        cauchy_scale_rad, "rad", 0.001, 3,
        "scale of the Cauchy loss on compass errors; lower values suppress magnetic disturbances more");
    RADIOSLAM_FIELD(
        independent_s, "s", 0.01, 1000,
        "time after which compass errors are independent; higher values lower the weight of the compass");
    RADIOSLAM_FIELD(sigma_heading_rad, "rad", 0.001, 3,
                    "standard deviation of one independent compass heading");
    RADIOSLAM_FIELD(sigma_drift_radps, "rad/s", 1e-9, 1,
                    "prior standard deviation of the calibrated gyroscope's bias about the vertical");
  }
};

/// Heading from east = gyroscope heading + offset_rad + drift_radps (t - middle).
struct CompassFit {
  Stamp middle;
  double offset_rad = 0;
  double drift_radps = 0;
  double spread_rad = 0;  ///< median absolute residual

  double correction_rad(Stamp stamp) const {
    return offset_rad + drift_radps * seconds_between(middle, stamp);
  }
};

/// Nothing without motion samples or orientations.
std::optional<CompassFit> fit_compass(const std::vector<LevelSample>& motion,
                                      const std::vector<OrientationSample>& orientation,
                                      const CompassParams& params);

// Step detection and step length from a phone's vertical acceleration.
//
// The vertical acceleration is band-pass filtered (difference of two Gaussian averages: one removes the
// jitter of heel strikes, the other residual gravity). A step is a peak above both a fraction of the signal's
// local root mean square and a floor, at least `min_step_s` after the previous one; of closer peaks the
// highest counts. A step lasts from the previous peak if that is at most `max_step_s` ago, else from
// `nominal_step_s` before its own peak. Length: Weinberg 2002, Using the ADXL202 in pedometer and personal
// navigation applications (AN-602): K (a_max - a_min)^(1/4) over the step.

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

struct DeadReckoningParams {
  LevellingParams levelling;
  StepParams steps;
  CompassParams compass;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("levelling", self.levelling);
    visit("steps", self.steps);
    visit("compass", self.compass);
  }
};

/// Dead-reckoned trajectory of one recording.
struct DeadReckoning {
  Trajectory<SE3> odometry;  ///< starts at the origin; a pose at both ends and at the end of every step
  std::vector<Step> steps;
  std::optional<CompassFit> compass;  ///< if present, yaw 0 is east
};

/// Trajectory from `begin` to `end` (`begin` < `end`); outside the sensors' recording, and without at least
/// one sample of accelerometer and gyroscope, the walker does not move.
DeadReckoning dead_reckon(const PhoneMotion& motion, Stamp begin, Stamp end,
                          const DeadReckoningParams& params);

/// Noise of pedestrian dead reckoning with a hand-held phone, measured on 65 walks of one surveyor (2.3 km,
/// 444 waypoints): the distance between waypoints has a total error of 0.47 m per sqrt(m), of which a scale
/// error of 0.12 per walk and a yaw drift of 0.004 rad/m are constant; the rest is rounded up.
OdometryNoise walking_noise();

}  // namespace radioslam

// Simulated wheel odometry with a gyroscope: white noise, and constant errors of scale and yaw drift.
//
// One increment with tangent (x, y, yaw), d = |(x, y)|, becomes
//   (1 + scale) (x, y) + normal, variance sigma_xy_per_sqrt_m^2 d each
//   yaw + drift d      + normal, variance sigma_yaw_per_sqrt_m_rad^2 d + sigma_yaw_per_rad^2 |yaw|
// with scale and drift drawn once per robot. The white part does not depend on how the path is divided
// (sigma_yaw_per_rad is the yaw's standard deviation after one radian of turning).
//
// The end error of dead reckoning determines how hard a mission is, and varies widely: over 600 m half of the
// draws end within 10 m, a tenth beyond 34 m. All errors are therefore drawn until the end is within
// [end_error_min_m, end_error_max_m] of the truth, with start and heading known; if no draw is, the closest
// one is used. Accepted draws follow the stated noise conditioned on the end error; with the defaults,
// accepted drifts have the stated standard deviation to within a tenth.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// True and stated errors of the odometry.
struct WheelOdometryParams {
  double odometry_rate_hz = 5;
  double sigma_xy_per_sqrt_m = 0.02;
  double sigma_yaw_per_sqrt_m_rad = 0.002;
  double sigma_yaw_per_rad = 0.01;
  double sigma_yaw_drift_per_m_rad = 0.0011;
  double sigma_scale = 0.01;
  double end_error_min_m = 10;
  double end_error_max_m = 20;
  int draws = 500;
  double stated_noise_factor = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(odometry_rate_hz, "Hz", 0.1, 1000, "odometry poses per second; 10 in Liu et al.");
    RADIOSLAM_BASIC_FIELD(sigma_xy_per_sqrt_m, "m/sqrt(m)", 0, 1, "white noise of x and y, per axis");
    RADIOSLAM_FIELD(sigma_yaw_per_sqrt_m_rad, "rad/sqrt(m)", 0, 1, "white noise of the yaw per path length");
    RADIOSLAM_FIELD(sigma_yaw_per_rad, "rad/sqrt(rad)", 0, 1,
                    "white noise of the yaw after one radian of turning");
    RADIOSLAM_FIELD(sigma_yaw_drift_per_m_rad, "rad/m", 0, 1,
                    "standard deviation of the yaw drift, constant per robot");
    RADIOSLAM_FIELD(sigma_scale, "", 0, 0.5, "standard deviation of the scale error, constant per robot");
    RADIOSLAM_FIELD(end_error_min_m, "m", 0, 1e6, "smallest end error of dead reckoning");
    RADIOSLAM_FIELD(end_error_max_m, "m", 0, 1e6, "largest end error of dead reckoning");
    RADIOSLAM_FIELD(draws, "", 1, 1e6, "largest number of draws until the end error fits");
    RADIOSLAM_FIELD(stated_noise_factor, "", 0.01, 100,
                    "ratio of stated to true noise; below 1 the odometry is overconfident");
  }
};

/// A robot's errors that are constant over the mission.
struct ConstantErrors {
  double yaw_drift_per_m_rad = 0;
  double scale = 0;
};

/// Poses T_start_body as odometry reports them, one for each true pose; the first is the identity.
struct DriftedDrive {
  ConstantErrors errors;
  std::vector<SE2> T_start_body;
  double end_error_m = 0;
};

/// Odometry along the true poses T_floor_body (at least one).
DriftedDrive draw_dead_reckoning(const std::vector<SE2>& T_floor_body, const WheelOdometryParams& params,
                                 Rng rng);

/// Odometry noise as a mission states it.
OdometryNoise stated_noise(const WheelOdometryParams& params);

}  // namespace radioslam

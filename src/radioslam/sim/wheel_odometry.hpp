// Dead reckoning as wheels and a gyroscope give it: white noise, and errors that stay the same all along.
//
// One increment with tangent (x, y, yaw), d = |(x, y)|, becomes
//   (1 + scale) (x, y) + normal, variance sigma_xy_per_sqrt_m^2 d each
//   yaw + drift d      + normal, variance sigma_yaw_per_sqrt_m_rad^2 d + sigma_yaw_per_rad^2 |yaw|
// with scale and drift drawn once per robot. The white part adds up to the same over any cut of the way
// (sigma_yaw_per_rad is the yaw's standard deviation after one radian of turning).
//
// How far off the dead reckoning ends is what makes a mission hard, and chance alone spreads it: over 600 m
// half of the draws end within 10 m, a tenth beyond 34 m. The errors are therefore drawn again, all of them,
// until the end lies within [end_error_min_m, end_error_max_m] of the truth, start and heading known. What is
// accepted is still a draw from the stated noise, given where it ends, and with the defaults the accepted
// drifts have the stated spread within a tenth. If no draw ends there, the one that came nearest stands.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// How wrong the odometry is, and how wrong it says it is.
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
    visit(Field{"odometry_rate_hz", "Hz", 0.1, 1000, "odometry poses per second; 10 in the published test"},
          self.odometry_rate_hz);
    visit(Field{"sigma_xy_per_sqrt_m", "m/sqrt(m)", 0, 1, "white noise of x and y, each"},
          self.sigma_xy_per_sqrt_m);
    visit(Field{"sigma_yaw_per_sqrt_m_rad", "rad/sqrt(m)", 0, 1, "white noise of the yaw"},
          self.sigma_yaw_per_sqrt_m_rad);
    visit(Field{"sigma_yaw_per_rad", "rad/sqrt(rad)", 0, 1,
                "white noise of the yaw after one radian of turning"},
          self.sigma_yaw_per_rad);
    visit(Field{"sigma_yaw_drift_per_m_rad", "rad/m", 0, 1, "yaw drift, constant per robot"},
          self.sigma_yaw_drift_per_m_rad);
    visit(Field{"sigma_scale", "", 0, 0.5, "relative error of distances, constant per robot"},
          self.sigma_scale);
    visit(Field{"end_error_min_m", "m", 0, 1e6, "dead reckoning ends at least this far off"},
          self.end_error_min_m);
    visit(Field{"end_error_max_m", "m", 0, 1e6, "dead reckoning ends at most this far off"},
          self.end_error_max_m);
    visit(Field{"draws", "", 1, 1e6, "odometry errors drawn at most until the end error fits"}, self.draws);
    visit(Field{"stated_noise_factor", "", 0.01, 100, "stated noise over true noise; 1 is honest"},
          self.stated_noise_factor);
  }
};

/// A robot's errors that do not change over the mission.
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

/// What a mission with this odometry states about its noise.
OdometryNoise stated_noise(const WheelOdometryParams& params);

}  // namespace radioslam

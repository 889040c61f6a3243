// Noise model of an inertial measurement unit: white noise and random-walk biases with a prior.
//
//   sample = truth + bias + noise,    noise of density s:  variance of its mean over t seconds s^2 / t
//   bias(t + dt) = bias(t) + walk,    variance walk^2 dt
#pragma once

#include <Eigen/Core>

#include "radioslam/base/fields.hpp"

namespace radioslam {

/// Defaults: an IMU as built into laser scanners and small robots, including vibration.
struct ImuNoiseParams {
  double accelerometer_noise = 5e-3;
  double gyroscope_noise = 5e-4;
  double accelerometer_walk = 1e-4;
  double gyroscope_walk = 1e-5;
  double sigma_accelerometer_bias_mps2 = 0.2;
  double sigma_gyroscope_bias_radps = 0.02;
  double integration_noise = 1e-4;
  double gravity_mps2 = 9.81;
  double max_gap_s = 0.1;
  double unmeasured_velocity_walk = 2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(accelerometer_noise, "m/s^2/sqrt(Hz)", 1e-6, 10,
                          "noise density of the accelerometer");
    RADIOSLAM_BASIC_FIELD(gyroscope_noise, "rad/s/sqrt(Hz)", 1e-8, 1, "noise density of the gyroscope");
    RADIOSLAM_FIELD(accelerometer_walk, "m/s^2/sqrt(s)", 1e-6, 1, "random walk of the accelerometer's bias");
    RADIOSLAM_FIELD(gyroscope_walk, "rad/s/sqrt(s)", 1e-7, 1, "random walk of the gyroscope's bias");
    RADIOSLAM_FIELD(sigma_accelerometer_bias_mps2, "m/s^2", 1e-6, 10,
                    "prior standard deviation of the accelerometer's initial bias, per axis");
    RADIOSLAM_FIELD(sigma_gyroscope_bias_radps, "rad/s", 1e-8, 1,
                    "prior standard deviation of the gyroscope's initial bias, per axis");
    RADIOSLAM_FIELD(integration_noise, "m/sqrt(s)", 1e-8, 1,
                    "random walk of the position from integrating samples of a finite rate");
    RADIOSLAM_FIELD(gravity_mps2, "m/s^2", 0, 30, "magnitude of gravity");
    RADIOSLAM_FIELD(max_gap_s, "s", 1e-3, 10,
                    "longest gap between IMU samples; motion over longer gaps counts as unmeasured");
    RADIOSLAM_FIELD(unmeasured_velocity_walk, "m/s/sqrt(s)", 1e-3, 1000,
                    "random walk of the velocity while IMU samples are missing");
  }

  /// Gravity's acceleration in a frame whose z points up.
  Eigen::Vector3d gravity() const { return {0, 0, -gravity_mps2}; }
};

}  // namespace radioslam

// Simulated inertial measurement unit at the body's origin, along a smooth motion.
//
//   f = R^T (a - g) + b_a + n_a,   w = (angular rate in the body frame) + b_g + n_g
//
// each instantaneous at the sample's stamp. n is white, of standard deviation density sqrt(rate) per sample;
// b starts at random and changes by a random walk of walk / sqrt(rate) from one sample to the next. Source of
// the defaults: white noise as EuRoC states it for the ADIS16448 (Burri et al. 2016); biases some time after
// a calibration, with a random walk by the unit's bias stability (0.25 mg, 14.5 deg/h, data sheet) in 100 s.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/sim/motion/true_motion.hpp"

namespace radioslam {

struct InertialUnitParams {
  double imu_hz = 0;
  double imu_accelerometer_density = 2e-3;
  double imu_gyroscope_density = 1.7e-4;
  double imu_accelerometer_bias_mps2 = 0.05;
  double imu_gyroscope_bias_radps = 0.002;
  double imu_accelerometer_walk = 2.5e-4;
  double imu_gyroscope_walk = 7e-6;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(imu_hz, "Hz", 0, 1000,
                          "IMU samples per second; 0: no IMU. With an IMU the true motion is smoothed");
    RADIOSLAM_FIELD(imu_accelerometer_density, "m/s^2/sqrt(Hz)", 0, 1,
                    "white noise density of the accelerometer (default: ADIS16448)");
    RADIOSLAM_FIELD(imu_gyroscope_density, "rad/s/sqrt(Hz)", 0, 1,
                    "white noise density of the gyroscope (default: ADIS16448)");
    RADIOSLAM_FIELD(imu_accelerometer_bias_mps2, "m/s^2", 0, 10,
                    "standard deviation of the accelerometer's initial bias, per axis");
    RADIOSLAM_FIELD(imu_gyroscope_bias_radps, "rad/s", 0, 1,
                    "standard deviation of the gyroscope's initial bias, per axis");
    RADIOSLAM_FIELD(imu_accelerometer_walk, "m/s^3/sqrt(Hz)", 0, 1,
                    "random walk of the accelerometer's bias");
    RADIOSLAM_FIELD(imu_gyroscope_walk, "rad/s^2/sqrt(Hz)", 0, 1, "random walk of the gyroscope's bias");
  }
};

inline constexpr double kStandardGravity_mps2 = 9.80665;

/// Samples from time 0 to the motion's end, which must be smooth; none at 0 Hz.
std::vector<ImuSample> simulate_inertial(const TrueMotion& motion, const InertialUnitParams& params,
                                         const Rng& rng);

}  // namespace radioslam

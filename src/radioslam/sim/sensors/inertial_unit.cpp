#include "radioslam/sim/sensors/inertial_unit.hpp"

#include <cmath>

namespace radioslam {
namespace {

Eigen::Vector3d normal_vector(double sigma, Rng& rng) {
  const double x = rng.normal(0, sigma), y = rng.normal(0, sigma), z = rng.normal(0, sigma);
  return {x, y, z};
}

/// Errors of the three axes of one kind of sensor.
class AxisErrors {
 public:
  AxisErrors(double density, double bias, double walk, double rate_hz, const Rng& rng)
      : sigma_white_(density * std::sqrt(rate_hz)),
        sigma_step_(walk / std::sqrt(rate_hz)),
        white_(rng.split("white")),
        walk_(rng.split("walk")) {
    Rng constant = rng.split("bias");
    bias_ = normal_vector(bias, constant);
  }

  Eigen::Vector3d next() {
    const Eigen::Vector3d error = bias_ + normal_vector(sigma_white_, white_);
    bias_ += normal_vector(sigma_step_, walk_);
    return error;
  }

 private:
  double sigma_white_, sigma_step_;
  Rng white_, walk_;
  Eigen::Vector3d bias_;
};

}  // namespace

std::vector<ImuSample> simulate_inertial(const TrueMotion& motion, const InertialUnitParams& params,
                                         const Rng& rng) {
  if (params.imu_hz <= 0) return {};
  const Eigen::Vector3d gravity_mps2(0, 0, -kStandardGravity_mps2);
  AxisErrors accelerometer(params.imu_accelerometer_density, params.imu_accelerometer_bias_mps2,
                           params.imu_accelerometer_walk, params.imu_hz, rng.split("accelerometer"));
  AxisErrors gyroscope(params.imu_gyroscope_density, params.imu_gyroscope_bias_radps,
                       params.imu_gyroscope_walk, params.imu_hz, rng.split("gyroscope"));
  std::vector<ImuSample> samples;
  const Stamp end = motion.end();
  for (int k = 0;; ++k) {
    const Stamp stamp = Stamp::from_seconds(k / params.imu_hz);
    if (stamp > end) break;
    const MotionState state = motion.state_at(stamp);
    const Eigen::Quaterniond R_body_common = state.T_common_body.rotation().conjugate();
    const Eigen::Vector3d force_mps2 = R_body_common * (state.acceleration_mps2 - gravity_mps2);
    samples.push_back(
        {stamp, force_mps2 + accelerometer.next(), state.angular_rate_radps + gyroscope.next()});
  }
  return samples;
}

}  // namespace radioslam

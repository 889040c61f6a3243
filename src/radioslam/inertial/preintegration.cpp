#include "radioslam/inertial/preintegration.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/imu_intervals.hpp"

namespace radioslam {
namespace {

using ErrorByError = Preintegration::Covariance;
using ErrorByReading = Eigen::Matrix<double, 9, 6>;  // [rate; force]

/// Jacobians of the error after one more interval by the error before and by the interval's sample.
struct ErrorStep {
  ErrorByError by_error = ErrorByError::Identity();
  ErrorByReading by_reading = ErrorByReading::Zero();
};

ErrorStep error_step(const Eigen::Quaterniond& rotation, double dt, const Eigen::Vector3d& rate,
                     const Eigen::Vector3d& force) {
  const Eigen::Vector3d turn = rate * dt;
  const Eigen::Quaterniond half = so3_exp(0.5 * turn);
  const Eigen::Matrix3d R = rotation.toRotationMatrix(), H = half.toRotationMatrix();
  const Eigen::Matrix3d middle = R * H;
  const Eigen::Matrix3d push_by_turn = -R * skew(half * force);       // derivative of middle * force
  const Eigen::Matrix3d push_by_middle_turn = -middle * skew(force);  // by a middle rotation
  const Eigen::Matrix3d middle_by_rate = 0.5 * dt * so3_left_jacobian(-0.5 * turn);
  const Eigen::Matrix3d push_by_rate = push_by_middle_turn * middle_by_rate;
  const double half_square = 0.5 * dt * dt;
  ErrorStep step;
  step.by_error.block<3, 3>(0, 3) = half_square * push_by_turn;
  step.by_error.block<3, 3>(0, 6) = dt * Eigen::Matrix3d::Identity();
  step.by_error.block<3, 3>(3, 3) = so3_exp(-turn).toRotationMatrix();
  step.by_error.block<3, 3>(6, 3) = dt * push_by_turn;
  step.by_reading.block<3, 3>(0, 0) = half_square * push_by_rate;
  step.by_reading.block<3, 3>(0, 3) = half_square * middle;
  step.by_reading.block<3, 3>(3, 0) = dt * so3_left_jacobian(-turn);
  step.by_reading.block<3, 3>(6, 0) = dt * push_by_rate;
  step.by_reading.block<3, 3>(6, 3) = dt * middle;
  return step;
}

/// Variance of the mean sample over `dt` seconds, [rate; force].
Eigen::Matrix<double, 6, 1> reading_variance(double dt, const ImuNoiseParams& params) {
  Eigen::Matrix<double, 6, 1> variance;
  variance.head<3>().setConstant(params.gyroscope_noise * params.gyroscope_noise / dt);
  variance.tail<3>().setConstant(params.accelerometer_noise * params.accelerometer_noise / dt);
  return variance;
}

void append_interval(Preintegration& sum, double dt, const Eigen::Vector3d& rate,
                     const Eigen::Vector3d& force, const ImuNoiseParams& params) {
  const ErrorStep step = error_step(sum.motion.rotation, dt, rate, force);
  sum.bias_jacobian = (step.by_error * sum.bias_jacobian - step.by_reading).eval();
  sum.covariance = (step.by_error * sum.covariance * step.by_error.transpose()).eval();
  sum.covariance += step.by_reading * reading_variance(dt, params).asDiagonal() * step.by_reading.transpose();
  sum.covariance.diagonal().head<3>().array() += params.integration_noise * params.integration_noise * dt;
  sum.motion.append(dt, rate, force);
}

}  // namespace

void FreeMotion::append(double duration, const Eigen::Vector3d& rate_radps,
                        const Eigen::Vector3d& force_mps2) {
  const Eigen::Vector3d turn = rate_radps * duration;
  const Eigen::Vector3d push = rotation * (so3_exp(0.5 * turn) * force_mps2);
  position_m += duration * velocity_mps + 0.5 * duration * duration * push;
  velocity_mps += duration * push;
  rotation = (rotation * so3_exp(turn)).normalized();
  duration_s += duration;
}

FreeMotion Preintegration::with_bias(const InertialBias& other) const {
  Eigen::Matrix<double, 6, 1> change;
  change << other.gyroscope_radps - bias.gyroscope_radps, other.accelerometer_mps2 - bias.accelerometer_mps2;
  const Error moved = bias_jacobian * change;
  return {motion.duration_s, motion.position_m + moved.segment<3>(kPosition),
          motion.rotation * so3_exp(moved.segment<3>(kRotation)),
          motion.velocity_mps + moved.segment<3>(kVelocity)};
}

std::optional<Preintegration> preintegrate(const std::vector<ImuSample>& samples, Stamp from, Stamp to,
                                           const InertialBias& bias, const ImuNoiseParams& params) {
  RADIOSLAM_CHECK(from < to, "a motion needs time");
  const auto intervals = imu_intervals(samples, from, to, params.max_gap_s);
  if (!intervals) return std::nullopt;
  Preintegration sum;
  sum.bias = bias;
  for (const ImuInterval& interval : *intervals)
    append_interval(sum, interval.duration_s, interval.angular_rate_radps - bias.gyroscope_radps,
                    interval.specific_force_mps2 - bias.accelerometer_mps2, params);
  return sum;
}

}  // namespace radioslam

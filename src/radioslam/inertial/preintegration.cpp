#include "radioslam/inertial/preintegration.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

using SampleIterator = std::vector<ImuSample>::const_iterator;

/// The first sample after `stamp`.
SampleIterator first_after(const std::vector<ImuSample>& samples, Stamp stamp) {
  return std::upper_bound(samples.begin(), samples.end(), stamp,
                          [](Stamp s, const ImuSample& sample) { return s < sample.stamp; });
}

/// The interpolated sample at `stamp`; nothing if its neighbours are too far apart.
std::optional<ImuSample> sample_at(const std::vector<ImuSample>& samples, Stamp stamp, double max_gap_s) {
  const auto after = first_after(samples, stamp);
  const ImuSample& b = after == samples.end() ? samples.back() : *after;
  const ImuSample& a = after == samples.begin() ? samples.front() : *(after - 1);
  const double gap = seconds_between(std::min(a.stamp, stamp), std::max(b.stamp, stamp));
  if (stamp != a.stamp && gap > max_gap_s) return std::nullopt;
  const double fraction =
      a.stamp < b.stamp ? seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp) : 0;
  return ImuSample{stamp, a.specific_force_mps2 + fraction * (b.specific_force_mps2 - a.specific_force_mps2),
                   a.angular_rate_radps + fraction * (b.angular_rate_radps - a.angular_rate_radps)};
}

ImuInterval between(const ImuSample& a, const ImuSample& b) {
  return {seconds_between(a.stamp, b.stamp), 0.5 * (a.angular_rate_radps + b.angular_rate_radps),
          0.5 * (a.specific_force_mps2 + b.specific_force_mps2)};
}

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

std::optional<std::vector<ImuInterval>> imu_intervals(const std::vector<ImuSample>& samples, Stamp from,
                                                      Stamp to, double max_gap_s) {
  RADIOSLAM_CHECK(from <= to, "the motion runs forward in time");
  if (samples.empty()) return std::nullopt;
  const auto first = sample_at(samples, from, max_gap_s), last = sample_at(samples, to, max_gap_s);
  if (!first || !last) return std::nullopt;
  std::vector<ImuInterval> intervals;
  ImuSample before = *first;
  for (auto next = first_after(samples, from); next != samples.end() && next->stamp < to; ++next) {
    if (seconds_between(before.stamp, next->stamp) > max_gap_s) return std::nullopt;
    intervals.push_back(between(before, *next));
    before = *next;
  }
  if (seconds_between(before.stamp, to) > max_gap_s) return std::nullopt;
  if (before.stamp < to) intervals.push_back(between(before, *last));
  return intervals;
}

InertialState InertialState::moved_by(const Tangent& step) const {
  return {T_world_body * SE3::exp(step.head<SE3::kDof>()),
          velocity_mps + step.segment<3>(kVelocity),
          {bias.gyroscope_radps + step.segment<3>(kGyroscope),
           bias.accelerometer_mps2 + step.segment<3>(kAccelerometer)},
          T_map_world * SE3::exp(step.segment<SE3::kDof>(kMap))};
}

InertialState::Tangent InertialState::step_to(const InertialState& there) const {
  Tangent step;
  step << (T_world_body.inverse() * there.T_world_body).log(), there.velocity_mps - velocity_mps,
      there.bias.gyroscope_radps - bias.gyroscope_radps,
      there.bias.accelerometer_mps2 - bias.accelerometer_mps2,
      (T_map_world.inverse() * there.T_map_world).log();
  return step;
}

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

InertialState state_after(const InertialState& state, const FreeMotion& motion,
                          const ImuNoiseParams& params) {
  const SE3& T = state.T_world_body;
  const double t = motion.duration_s;
  const Eigen::Vector3d g = params.gravity();
  const Eigen::Vector3d position =
      T.translation() + t * state.velocity_mps + 0.5 * t * t * g + T.rotate(motion.position_m);
  return {SE3(position, T.rotation() * motion.rotation),
          state.velocity_mps + t * g + T.rotate(motion.velocity_mps), state.bias, state.T_map_world};
}

std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<ImuSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const ImuNoiseParams& params) {
  std::vector<InertialState> states;
  FreeMotion motion;
  Stamp reached = start;
  for (const Stamp stamp : stamps) {
    RADIOSLAM_CHECK(reached <= stamp, "the times do not decrease");
    const auto intervals = imu_intervals(samples, reached, stamp, params.max_gap_s);
    if (!intervals) return std::nullopt;
    for (const ImuInterval& interval : *intervals)
      motion.append(interval.duration_s, interval.angular_rate_radps - state.bias.gyroscope_radps,
                    interval.specific_force_mps2 - state.bias.accelerometer_mps2);
    states.push_back(state_after(state, motion, params));
    reached = stamp;
  }
  return states;
}

}  // namespace radioslam

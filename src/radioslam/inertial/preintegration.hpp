// IMU preintegration on the manifold (Forster, Carlone, Dellaert, Scaramuzza, "On-Manifold Preintegration for
// Real-Time Visual-Inertial Odometry", T-RO 2017): IMU samples between two times as one measurement in the
// body frame at the first, which need not be integrated again when pose, velocity or bias change.
//
//   rotation = prod Exp((w - b_g) dt)                        = R_i^T R_j
//   velocity = sum R_i_k a_k dt, a_k = sample - b_a           = R_i^T (v_j - v_i - g t)
//   position = sum velocity dt + R_i_k a_k dt^2 / 2           = R_i^T (p_j - p_i - v_i t - g t^2 / 2)
//
// Each interval rotates at a constant rate and accelerates along its mid-point
// orientation, which makes the integration error quadratic in the sampling interval.
// Errors are [position (added); rotation (on the right, Exp); velocity (added)], propagated to first order:
//   e <- F e + B [noise of the rate; noise of the force],  P <- F P F^T + B Q B^T + integration noise
// Cost: 9 x 9 products per sample.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/inertial/imu_noise.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

/// IMU samples as intervals of constant rate and force: between successive samples, with the mean of both.
///
/// The ends of the requested time are interpolated; before the first (after the last) sample its values hold.
/// Refuses gaps longer than `max_gap_s` without a sample, at the ends as well.
/// Cost: samples in between, and a binary search.
struct ImuInterval {
  double duration_s = 0;
  Eigen::Vector3d angular_rate_radps;
  Eigen::Vector3d specific_force_mps2;
};

/// Intervals from `from` to `to`, in order; `samples` are sorted by time and `from` <= `to`.
std::optional<std::vector<ImuInterval>> imu_intervals(const std::vector<ImuSample>& samples, Stamp from,
                                                      Stamp to, double max_gap_s);

// State of LiDAR-inertial estimation: pose, velocity, IMU biases, and the pose of the world on the map.
//
// The world's z points up; the map is the one that poses are measured on, by scan matching for example.
// Tangent of a state, 21 numbers, in this order:
//   [translation, rotation of T_world_body Exp(xi) (m, rad); velocity (m/s); bias of the gyroscope (rad/s);
//    bias of the accelerometer (m/s^2); translation, rotation of T_map_world Exp(xi)]

/// Measured minus true.
struct InertialBias {
  Eigen::Vector3d gyroscope_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_mps2 = Eigen::Vector3d::Zero();
};

struct InertialState {
  static constexpr int kDof = 21;
  static constexpr int kVelocity = 6, kGyroscope = 9, kAccelerometer = 12, kMap = 15;  ///< tangent offsets
  using Tangent = Eigen::Matrix<double, kDof, 1>;
  using Jacobian = Eigen::Matrix<double, kDof, kDof>;

  SE3 T_world_body;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< of the body's origin, in the world
  InertialBias bias;
  SE3 T_map_world = {};

  InertialState moved_by(const Tangent& step) const;
  /// Inverse of moved_by: the step from this state to `there`.
  Tangent step_to(const InertialState& there) const;
};

/// Motion of the body in its frame at the start, relative to free fall: without gravity and initial velocity.
struct FreeMotion {
  double duration_s = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();

  /// Appends `duration` seconds of constant rate and force, biases already subtracted.
  void append(double duration, const Eigen::Vector3d& rate_radps, const Eigen::Vector3d& force_mps2);
};

/// A free motion with its covariance and its dependence on the bias.
struct Preintegration {
  static constexpr int kPosition = 0, kRotation = 3, kVelocity = 6;  ///< offsets in the error
  using Error = Eigen::Matrix<double, 9, 1>;
  using Covariance = Eigen::Matrix<double, 9, 9>;

  FreeMotion motion;  ///< integrated with `bias`
  InertialBias bias;
  /// Derivative of the motion by [gyroscope bias; accelerometer bias].
  Eigen::Matrix<double, 9, 6> bias_jacobian = Eigen::Matrix<double, 9, 6>::Zero();
  Covariance covariance = Covariance::Zero();  ///< of the white noise, without the biases' random walk

  /// The motion for another bias, to first order.
  FreeMotion with_bias(const InertialBias& other) const;
};

/// Nothing if the samples have too long a gap. `from` < `to`.
std::optional<Preintegration> preintegrate(const std::vector<ImuSample>& samples, Stamp from, Stamp to,
                                           const InertialBias& bias, const ImuNoiseParams& params);

// Predicts a body's motion from a known state by IMU samples alone, for deskewing and as an initial pose.
//
//   p(t) = p + v t + g t^2 / 2 + R position,  v(t) = v + g t + R velocity,  R(t) = R rotation
//
// with the free motion of preintegration.hpp. Refuses gaps in the samples longer than `max_gap_s`.
// Cost: samples between the start and the last time, and a binary search per time.

/// The state after a free motion from `state`; the biases stay the same.
InertialState state_after(const InertialState& state, const FreeMotion& motion, const ImuNoiseParams& params);

/// The states at `stamps`, which do not decrease and are not before `start`, the time of `state`.
std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<ImuSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const ImuNoiseParams& params);

}  // namespace radioslam

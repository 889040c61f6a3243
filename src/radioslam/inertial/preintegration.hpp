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

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

// Noise model of an inertial measurement unit: white noise and random-walk biases with a prior.
//
//   sample = truth + bias + noise,    noise of density s:  variance of its mean over t seconds s^2 / t
//   bias(t + dt) = bias(t) + walk,    variance walk^2 dt

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

// IMU preintegration on the manifold (Forster, Carlone, Dellaert, Scaramuzza, "On-Manifold Preintegration for
// Real-Time Visual-Inertial Odometry", T-RO 2017): IMU samples between two times as one measurement in the
// body frame at the first, which need not be integrated again when pose, velocity or bias change.
//
//   rotation = prod Exp((w - b_g) dt)                        = R_i^T R_j
//   velocity = sum R_i_k a_k dt, a_k = sample - b_a           = R_i^T (v_j - v_i - g t)
//   position = sum velocity dt + R_i_k a_k dt^2 / 2           = R_i^T (p_j - p_i - v_i t - g t^2 / 2)
//
// Each interval (imu_intervals.hpp) rotates at a constant rate and accelerates along its mid-point
// orientation, which makes the integration error quadratic in the sampling interval.
// Errors are [position (added); rotation (on the right, Exp); velocity (added)], propagated to first order:
//   e <- F e + B [noise of the rate; noise of the force],  P <- F P F^T + B Q B^T + integration noise
// Cost: 9 x 9 products per sample.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "radioslam/inertial/imu_noise.hpp"
#include "radioslam/inertial/inertial_state.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

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

}  // namespace radioslam

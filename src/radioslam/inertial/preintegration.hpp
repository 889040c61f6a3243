// Inertial readings between two times summed up once, in the body's frame at the first of them, so that they
// need not be summed again when the pose, the velocity or the bias there changes (Forster, Carlone, Dellaert,
// Scaramuzza, "On-Manifold Preintegration for Real-Time Visual-Inertial Odometry", T-RO 2017).
//
//   rotation = prod Exp((w - b_g) dt)                        = R_i^T R_j
//   velocity = sum R_i_k a_k dt, a_k = reading - b_a          = R_i^T (v_j - v_i - g t)
//   position = sum velocity dt + R_i_k a_k dt^2 / 2           = R_i^T (p_j - p_i - v_i t - g t^2 / 2)
//
// Each piece (reading_intervals.hpp) turns at a constant rate and pushes along its middle orientation, which
// makes the error of a sum fall with the square of the time between readings.
// Errors are [position (added); rotation (on the right, Exp); velocity (added)], propagated to first order:
//   e <- F e + B [noise of the rate; noise of the force],  covariance <- F P F^T + B Q B^T + integration
//   noise.
// Cost: 9 x 9 products per reading.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "radioslam/inertial/inertial_noise.hpp"
#include "radioslam/inertial/inertial_state.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

/// Motion of the body seen from its frame at the start, in free fall: without gravity and the velocity there.
struct FreeMotion {
  double duration_s = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();

  /// Followed by `duration` seconds at a constant rate and force, less the biases.
  void append(double duration, const Eigen::Vector3d& rate_radps, const Eigen::Vector3d& force_mps2);
};

/// A free motion with what it depends on.
struct Preintegration {
  static constexpr int kPosition = 0, kRotation = 3, kVelocity = 6;  ///< where they begin in the error
  using Error = Eigen::Matrix<double, 9, 1>;
  using Covariance = Eigen::Matrix<double, 9, 9>;

  FreeMotion motion;  ///< with `bias`
  InertialBias bias;
  /// Change of the motion's error per unit of [gyroscope's bias; accelerometer's bias].
  Eigen::Matrix<double, 9, 6> bias_jacobian = Eigen::Matrix<double, 9, 6>::Zero();
  Covariance covariance = Covariance::Zero();  ///< of the noise; the biases' walk is not in it

  /// The motion with another bias, to first order.
  FreeMotion with_bias(const InertialBias& other) const;
};

/// Nothing where the readings leave too long a gap. `from` < `to`.
std::optional<Preintegration> preintegrate(const std::vector<InertialSample>& samples, Stamp from, Stamp to,
                                           const InertialBias& bias, const InertialNoiseParams& params);

}  // namespace radioslam

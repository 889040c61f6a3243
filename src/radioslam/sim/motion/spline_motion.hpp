// Cubic spline motion with continuous accelerations, for simulated inertial units: a uniform B-spline of
// positions and of rotations.
//
//   p(u) = sum of B_j(u) p_j,   R(u) = R_0 Exp(b_1 w_1) Exp(b_2 w_2) Exp(b_3 w_3),   w_j = Log(R_{j-1}^T R_j)
//
// over the four controls around u, with b_j the cumulative basis functions. It passes near its controls, not
// through them; accelerations and angular rates are continuous. Sources: Kim, Kim and Shin 1995; Sommer et
// al. 2020, equations 11 to 14. Positions, velocities and accelerations in the common frame, rates in the
// body frame.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// State of a moving body at one time.
struct MotionState {
  SE3 T_common_body;
  Eigen::Vector3d velocity_mps;
  Eigen::Vector3d acceleration_mps2;
  Eigen::Vector3d angular_rate_radps;
};

class SplineMotion {
 public:
  /// Controls k = 0, 1, ... (at least four) at times (k - 1) `knot_s`; rotations of neighbours differ by less
  /// than pi.
  SplineMotion(std::vector<SE3> controls, double knot_s);

  /// The motion is defined from time 0 to here.
  double end_s() const { return knot_s_ * static_cast<double>(controls_.size() - 3); }
  /// The state at a time clamped to [0, end].
  MotionState at(Stamp stamp) const;
  SE3 pose_at(Stamp stamp) const { return at(stamp).T_common_body; }

 private:
  std::vector<SE3> controls_;
  std::vector<Eigen::Vector3d> turns_;  ///< w from each control to the next
  double knot_s_ = 1;
};

}  // namespace radioslam

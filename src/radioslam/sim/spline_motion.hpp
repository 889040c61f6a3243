// A motion that is smooth enough for an inertial unit: a uniform cubic B-spline of positions and of
// rotations.
//
//   p(u) = sum of B_j(u) p_j,   R(u) = R_0 Exp(b_1 w_1) Exp(b_2 w_2) Exp(b_3 w_3),   w_j = Log(R_{j-1}^T R_j)
//
// over the four controls around u, with b_j the sums of the last B's. It passes near its controls, not
// through them; acceleration and rate of turn are continuous. Source: Kim, Kim and Shin 1995; Sommer et al.
// 2020, equations 11 to 14. Positions, velocities and accelerations in the common frame, rates in the body's.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// A moving body at one time.
struct MotionState {
  SE3 T_common_body;
  Eigen::Vector3d velocity_mps;
  Eigen::Vector3d acceleration_mps2;
  Eigen::Vector3d angular_rate_radps;
};

class SplineMotion {
 public:
  /// Controls k = 0, 1, ... (at least four) at the times (k - 1) `knot_s`; rotations of neighbours less than
  /// pi apart.
  SplineMotion(std::vector<SE3> controls, double knot_s);

  /// The motion is known from time 0 to here.
  double end_s() const { return knot_s_ * static_cast<double>(controls_.size() - 3); }
  /// At a time from 0 to the end; clamped to them.
  MotionState at(Stamp stamp) const;
  SE3 pose_at(Stamp stamp) const { return at(stamp).T_common_body; }

 private:
  std::vector<SE3> controls_;
  std::vector<Eigen::Vector3d> turns_;  ///< w from each control to the next
  double knot_s_ = 1;
};

}  // namespace radioslam

// Converts the smoothed states' joint covariance into odometry noise that is independent from step to step.
//
// Errors of the states are correlated: a wrong velocity or tilt persists for seconds, or for the whole length
// of a corridor that only the IMU bridges. Single-step covariances, added up as if independent, would be
// overconfident. They are inflated to add up to at least the joint covariance over spans of 1, 2, 4, ...
// steps:
//
//   D_k           of step k alone, of T_k_k+1 Exp(xi)
//   for each span from a to b:  S = sum A_k D_k A_k^T, A_k = Ad(T_b_k+1); C = covariance of T_a_b
//     S = L L^T, L^-1 C L^-T = U diag(l) U^T
//     deficit: the sum of max(0, l_m - 1) e_m e_m^T, e_m = L u_m
//     D_k <- D_k + A_k^-1 (sum of w_km max(0, l_m - 1) e_m e_m^T) A_k^-T,
//     w_km = u_m^T L^-1 A_k D_k A_k^T L^-T u_m: the step's fraction of that direction; the fractions sum to 1
//
// Noise is only ever added: where errors partly cancel the result is too large, never too small, except for
// spans that begin inside one of these and end inside another. Cost: linear in the states for each doubling.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct OdometryNoiseInflationParams {
  double max_span_s = 60;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        max_span_s, "s", 0, 1e6,
        "longest span over which odometry noise is inflated to add up to the smoothed states' covariance");
  }
};

/// One per step between successive states.
std::vector<OdometryStepNoise> odometry_noise_inflation(const InertialTrajectory& trajectory,
                                                        const OdometryNoiseInflationParams& params);

}  // namespace radioslam

// The smoothed states' errors as noise of an odometry, which is a random walk: independent from step to step.
// The states' errors are not: a wrong velocity or tilt shows for seconds, and along a corridor that only the
// readings bridge, for all of its length. The covariances of single steps, added up as if they were
// independent, would promise a multiple of the accuracy that there is. So the noise is made to add up to at
// least what the joint covariance says over every span of 1, 2, 4, ... steps:
//
//   D_k           of step k alone, of T_k_k+1 Exp(xi)
//   for each span from a to b:  S = sum A_k D_k A_k^T, A_k = Ad(T_b_k+1); C = covariance of T_a_b
//     S = L L^T, L^-1 C L^-T = U diag(l) U^T; what is missing: the sum of max(0, l_m - 1) e_m e_m^T, e_m = L
//     u_m D_k <- D_k + A_k^-1 (sum of w_km max(0, l_m - 1) e_m e_m^T) A_k^-T, w_km = u_m^T L^-1 A_k D_k A_k^T
//     L^-T u_m: every step's share of what it had of that direction; their sum is 1
//
// Noise is only ever added: over spans whose errors partly cancel it promises less than there is, never more,
// up to spans that begin within one of these and end within another. Cost: linear in the states for each
// doubling.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct OdometryNoiseOfStatesParams {
  double longest_span_s = 60;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"longest_span_s", "s", 0, 1e6, "over which the noise must add up to the states' covariance"},
          self.longest_span_s);
  }
};

/// One per step from state to state.
std::vector<OdometryStepNoise> odometry_noise_of_states(const InertialTrajectory& trajectory,
                                                        const OdometryNoiseOfStatesParams& params);

}  // namespace radioslam

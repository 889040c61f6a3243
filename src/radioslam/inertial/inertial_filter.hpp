// Inertial filter: the forward pass of the smoother (inertial_smoother.hpp), for measurements as they arrive.
//
//   minimise  |mean^-1 x_i|^2_L + (all of state_factors.hpp between i and j)  over x_i and x_j
//   L_j = H_jj - H_ji (L + H_ii)^-1 H_ij
//
// A few Gauss-Newton steps over both states: directions that the poses do not constrain follow the IMU, and
// the biases are estimated. Refuses a step that leaves a direction undetermined, without IMU samples and with
// a map pose of less than full rank.
#pragma once

#include "radioslam/inertial/state_factors.hpp"

namespace radioslam {

class InertialFilter {
 public:
  explicit InertialFilter(const StatePrior& start) : belief_(start) {}

  const InertialState& state() const { return belief_.mean; }
  /// The state with its information.
  const StatePrior& belief() const { return belief_; }
  InertialState::Jacobian covariance() const;

  enum class Advance { kDone, kUndetermined };
  /// Advances to the end of the step; if that state is undetermined, nothing changes.
  Advance advance(const StateStep& step, const ImuNoiseParams& params);

 private:
  StatePrior belief_;
};

}  // namespace radioslam

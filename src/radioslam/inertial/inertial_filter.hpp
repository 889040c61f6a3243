// A robot's state as measurements come in: the forward half of the smoother (inertial_smoother.hpp), for an
// odometry under way.
//
//   minimise  |mean^-1 x_i|^2_L + (all of state_factors.hpp between i and j)  over x_i and x_j
//   L_j = H_jj - H_ji (L + H_ii)^-1 H_ij
//
// A few Gauss-Newton steps over both states, so that a direction which the poses do not measure is carried by
// the readings, and the biases are learnt under way.
// Refuses a step that leaves something open: no readings, and a pose on the map of less than full rank.
#pragma once

#include "radioslam/inertial/state_factors.hpp"

namespace radioslam {

class InertialFilter {
 public:
  explicit InertialFilter(const StatePrior& start) : belief_(start) {}

  const InertialState& state() const { return belief_.mean; }
  /// With its information.
  const StatePrior& belief() const { return belief_; }
  InertialState::Jacobian covariance() const;

  enum class Advance { kDone, kUndetermined };
  /// Moves on to the step's end; where that stays undetermined, nothing changes.
  Advance advance(const StateStep& step, const InertialNoiseParams& params);

 private:
  StatePrior belief_;
};

}  // namespace radioslam

// What ties the states of one robot: what is known of a state beforehand, and what was measured from one
// state to the next. Squared norms of
//
//   prior            mean^-1 state, of any information
//   relative pose    Log(Z^-1 T_i^-1 T_j), of any information, none along a corridor without features;
//                    beyond c standard deviations a squared norm s counts as c^2 (1 + log(s / c^2)): a wrong
//                    registration pulls the less the further it is off
//   readings         inertial_factor.hpp
//   biases           b_j - b_i, of the walk's variance
//   velocity         v_j - v_i where readings are missing, so that it stays defined
//
// Information matrices here, not covariances: where a direction was not measured there is no covariance.
#pragma once

#include <limits>
#include <optional>

#include "radioslam/inertial/inertial_factor.hpp"

namespace radioslam {

struct StatePrior {
  InertialState mean;
  InertialState::Jacobian information = InertialState::Jacobian::Zero();
};

/// A motion as measured from outside, by laser scans, say.
struct PoseStep {
  SE3 T_i_j;
  SE3::Jacobian information = SE3::Jacobian::Zero();                ///< of T_i_j Exp(xi); zero: not measured
  double outlier_sigmas = std::numeric_limits<double>::infinity();  ///< c; of a norm of six dimensions
};

/// Everything between two successive states.
struct StateStep {
  PoseStep pose;
  std::optional<Preintegration> readings;
  Preintegration::Covariance readings_information = Preintegration::Covariance::Zero();
  double duration_s = 0;
};

StateStep state_step(const PoseStep& pose, std::optional<Preintegration> readings, double duration_s);

/// Half the second derivative of a squared norm by one state or two, and half its slope.
struct PriorTerms {
  InertialState::Jacobian information;
  InertialState::Tangent slope;
  double cost = 0;
};
struct StepTerms {
  InertialState::Jacobian i_i, j_i, j_j;  ///< j_i: row j, column i
  InertialState::Tangent slope_i, slope_j;
  double cost = 0;
};

double cost_of(const StatePrior& prior, const InertialState& state);
double cost_of(const StateStep& step, const InertialState& i, const InertialState& j,
               const InertialNoiseParams& params);
PriorTerms linearise(const StatePrior& prior, const InertialState& state);
StepTerms linearise(const StateStep& step, const InertialState& i, const InertialState& j,
                    const InertialNoiseParams& params);

}  // namespace radioslam

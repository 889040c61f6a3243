// What ties the states of one robot: what is known of a state beforehand, and what was measured from one
// state to the next. Squared norms of
//
//   prior            mean^-1 state, of any information
//   pose on the map  Log(Z^-1 M T), M = T_map_world, of any information, none along a corridor without
//                    features; beyond c standard deviations a squared norm s counts as c^2 (1 + log(s /
//                    c^2)): a wrong registration pulls the less the further it is off
//   map's drift      Log(T_i^-1 M_i^-1 M_j T_i): a map that grows as the body goes is nowhere quite straight
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

/// A pose as measured from outside, by a laser scan on the map of those before it, say.
struct MapPose {
  SE3 T_map_body;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< of T_map_body Exp(xi); zero: not measured
  double outlier_sigmas = std::numeric_limits<double>::infinity();  ///< c; of a norm of six dimensions
};

/// Everything between two successive states.
struct StateStep {
  MapPose pose;                                           ///< of the later one
  SE3::Jacobian map_information = SE3::Jacobian::Zero();  ///< of the map's drift, in the earlier body's frame
  std::optional<Preintegration> readings;
  Preintegration::Covariance readings_information = Preintegration::Covariance::Zero();
  double duration_s = 0;
};

/// `map_drift`: covariance, positive definite.
StateStep state_step(const MapPose& pose, const SE3::Jacobian& map_drift,
                     std::optional<Preintegration> readings, double duration_s);

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

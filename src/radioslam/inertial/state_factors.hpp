// Factors of the inertial smoother: a prior on a state, and measurements between successive states.
//
//   prior            mean^-1 state, of any information
//   pose on the map  Log(Z^-1 M T), M = T_map_world, of any information (none along a featureless corridor);
//                    beyond c standard deviations a squared norm s counts as c^2 (1 + log(s / c^2)), so that
//                    a wrong registration pulls less the further it is off
//   map drift        Log(T_i^-1 M_i^-1 M_j T_i): the map deforms as it grows
//   IMU              the preintegrated motion, below
//   biases           b_j - b_i, with the random walk's variance
//   velocity         v_j - v_i where IMU samples are missing, so that it stays determined
//
// Costs are squared norms. Information matrices instead of covariances allow for unmeasured directions.
#pragma once

#include <limits>
#include <optional>

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

// Preintegrated IMU factor between two states (Forster et al. 2017, eq. 45):
//
//   position   R_i^T (p_j - p_i - v_i t - g t^2 / 2) - position(b_i)
//   rotation   Log(rotation(b_i)^T R_i^T R_j)
//   velocity   R_i^T (v_j - v_i - g t) - velocity(b_i)
//
// Order and covariance as in preintegration.hpp. The bias is the first state's; its random walk is another
// factor. Jacobians are for the tangents of preintegration.hpp.

using InertialResidual = Preintegration::Error;
using InertialResidualByState =
    Eigen::Matrix<double, InertialResidual::RowsAtCompileTime, InertialState::kDof>;

struct LinearInertialFactor {
  InertialResidual residual;
  InertialResidualByState by_i, by_j;
};

InertialResidual inertial_residual(const InertialState& i, const InertialState& j,
                                   const Preintegration& measured, const ImuNoiseParams& params);

LinearInertialFactor linearise_inertial(const InertialState& i, const InertialState& j,
                                        const Preintegration& measured, const ImuNoiseParams& params);

struct StatePrior {
  InertialState mean;
  InertialState::Jacobian information = InertialState::Jacobian::Zero();
};

/// A measured pose on the map, for example by scan matching.
struct MapPose {
  SE3 T_map_body;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< about xi in T_map_body Exp(xi); zero: not measured
  double outlier_sigmas = std::numeric_limits<double>::infinity();  ///< c, for a norm of six dimensions
};

/// All measurements between two successive states.
struct StateStep {
  MapPose pose;                                           ///< of the later state
  SE3::Jacobian map_information = SE3::Jacobian::Zero();  ///< of the map drift, in the earlier body frame
  std::optional<Preintegration> readings;
  Preintegration::Covariance imu_information = Preintegration::Covariance::Zero();
  double duration_s = 0;
};

/// `map_drift`: positive definite covariance.
StateStep state_step(const MapPose& pose, const SE3::Jacobian& map_drift,
                     std::optional<Preintegration> readings, double duration_s);

/// Gauss-Newton Hessian and gradient of half a squared norm, by one state or two; its full cost.
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
               const ImuNoiseParams& params);
PriorTerms linearise(const StatePrior& prior, const InertialState& state);
StepTerms linearise(const StateStep& step, const InertialState& i, const InertialState& j,
                    const ImuNoiseParams& params);

}  // namespace radioslam

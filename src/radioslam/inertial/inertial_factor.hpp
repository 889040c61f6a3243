// Preintegrated IMU factor between two states (Forster et al. 2017, eq. 45):
//
//   position   R_i^T (p_j - p_i - v_i t - g t^2 / 2) - position(b_i)
//   rotation   Log(rotation(b_i)^T R_i^T R_j)
//   velocity   R_i^T (v_j - v_i - g t) - velocity(b_i)
//
// Order and covariance as in preintegration.hpp. The bias is the first state's; its random walk is another
// factor. Jacobians are for the tangents of inertial_state.hpp.
#pragma once

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

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

}  // namespace radioslam

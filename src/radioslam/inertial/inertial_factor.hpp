// How well two states agree with the inertial readings between them (Forster et al. 2017, eq. 45):
//
//   position   R_i^T (p_j - p_i - v_i t - g t^2 / 2) - position(b_i)
//   rotation   Log(rotation(b_i)^T R_i^T R_j)
//   velocity   R_i^T (v_j - v_i - g t) - velocity(b_i)
//
// in the order, and with the covariance, of preintegration.hpp. The bias is that of the first state; that the
// second one has nearly the same is another factor. Jacobians for the tangents of inertial_state.hpp.
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
                                   const Preintegration& measured, const InertialNoiseParams& params);

LinearInertialFactor linearise_inertial(const InertialState& i, const InertialState& j,
                                        const Preintegration& measured, const InertialNoiseParams& params);

}  // namespace radioslam

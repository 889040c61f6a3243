#include "radioslam/inertial/inertial_filter.hpp"

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

constexpr int kFilterRounds = 3;  // from the predicted state; more change next to nothing

using Block = InertialState::Jacobian;

/// Prediction of the step's end state.
InertialState first_guess(const InertialState& i, const StateStep& step, const ImuNoiseParams& params) {
  if (step.readings) return state_after(i, step.readings->with_bias(i.bias), params);
  return {i.T_map_world.inverse() * step.pose.T_map_body, i.velocity_mps, i.bias, i.T_map_world};
}

}  // namespace

Block InertialFilter::covariance() const { return Cholesky<Block>(belief_.information).inverse(); }

InertialFilter::Advance InertialFilter::advance(const StateStep& step, const ImuNoiseParams& params) {
  InertialState i = belief_.mean, j = first_guess(i, step, params);
  Block information;
  for (int round = 0; round < kFilterRounds; ++round) {
    const PriorTerms known = linearise(belief_, i);
    const StepTerms terms = linearise(step, i, j, params);
    const Cholesky<Block> before(known.information + terms.i_i);
    if (!before.succeeded()) return Advance::kUndetermined;
    const InertialState::Tangent slope_i = known.slope + terms.slope_i;
    information = before.schur_complement(terms.j_j, terms.j_i);
    const Cholesky<Block> after(information);
    if (!after.succeeded()) return Advance::kUndetermined;
    const InertialState::Tangent step_j = -after.solve(terms.slope_j - terms.j_i * before.solve(slope_i));
    i = i.moved_by(-before.solve(slope_i + terms.j_i.transpose() * step_j));
    j = j.moved_by(step_j);
  }
  belief_ = {j, 0.5 * (information + information.transpose())};
  return Advance::kDone;
}

}  // namespace radioslam

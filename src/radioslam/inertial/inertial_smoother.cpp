#include "radioslam/inertial/inertial_smoother.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/inertial/inertial_filter.hpp"

namespace radioslam {
namespace {

using Block = InertialState::Jacobian;

auto lower(const Block& block) { return block.triangularView<Eigen::Lower>(); }

using States = std::vector<InertialState>;
using Slopes = std::vector<InertialState::Tangent>;

/// The drive as a least squares problem.
struct ChainProblem {
  StatePrior prior;
  std::vector<StateStep> steps;
  const InertialDrive& drive;
  const std::vector<ImuSample>& samples;
  const ImuNoiseParams& noise;

  /// Step k with the IMU samples preintegrated for this bias.
  StateStep step_for(std::size_t k, const InertialBias& bias) const {
    const Stamp from = drive.stamps[k], to = drive.stamps[k + 1];
    return state_step(drive.poses[k + 1], drive.map_drifts[k], preintegrate(samples, from, to, bias, noise),
                      seconds_between(from, to));
  }
};

/// The filter's states; IMU samples are preintegrated with the biases estimated by then.
std::optional<States> pass_forward(ChainProblem& problem) {
  InertialFilter filter(problem.prior);
  States states{filter.state()};
  for (std::size_t k = 0; k < problem.drive.map_drifts.size(); ++k) {
    problem.steps.push_back(problem.step_for(k, filter.state().bias));
    if (filter.advance(problem.steps.back(), problem.noise) == InertialFilter::Advance::kUndetermined)
      return std::nullopt;
    states.push_back(filter.state());
  }
  return states;
}

double total_cost(const ChainProblem& problem, const States& states) {
  double cost = cost_of(problem.prior, states.front());
  for (std::size_t k = 0; k < problem.steps.size(); ++k)
    cost += cost_of(problem.steps[k], states[k], states[k + 1], problem.noise);
  return cost;
}

struct LinearChain {
  ChainMatrix matrix;
  Slopes downhill;  ///< negative gradient
  double cost = 0;
};

LinearChain linearise(const ChainProblem& problem, const States& states) {
  const std::size_t n = states.size();
  LinearChain linear;
  linear.matrix.diagonal.assign(n, InertialState::Jacobian::Zero());
  linear.matrix.below.assign(n - 1, InertialState::Jacobian::Zero());
  linear.downhill.assign(n, InertialState::Tangent::Zero());
  const PriorTerms known = linearise(problem.prior, states.front());
  linear.matrix.diagonal.front() = known.information;
  linear.downhill.front() = -known.slope;
  linear.cost = known.cost;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const StepTerms terms = linearise(problem.steps[k], states[k], states[k + 1], problem.noise);
    linear.matrix.diagonal[k] += terms.i_i;
    linear.matrix.diagonal[k + 1] += terms.j_j;
    linear.matrix.below[k] = terms.j_i;
    linear.downhill[k] -= terms.slope_i;
    linear.downhill[k + 1] -= terms.slope_j;
    linear.cost += terms.cost;
  }
  return linear;
}

States moved(const States& states, const Slopes& steps) {
  States result;
  result.reserve(states.size());
  for (std::size_t k = 0; k < states.size(); ++k) result.push_back(states[k].moved_by(steps[k]));
  return result;
}

double dot(const Slopes& a, const Slopes& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k].dot(b[k]);
  return sum;
}

struct Minimum {
  States states;
  int iterations = 0;
  bool converged = false;
};

/// Damped Gauss-Newton steps that each lower the cost, until the predicted decrease is below the tolerance.
Minimum minimise(const ChainProblem& problem, States states, const InertialSmootherParams& params) {
  Minimum result{std::move(states)};
  LinearChain linear = linearise(problem, result.states);
  double damping = 0;
  for (; result.iterations < params.max_iterations && damping <= params.max_damping; ++result.iterations) {
    const auto factor = ChainFactor::compute(linear.matrix, damping);
    if (factor) {
      const Slopes step = factor->solve(linear.downhill);
      if ((result.converged = dot(step, linear.downhill) < params.cost_tolerance)) return result;
      States next = moved(result.states, step);
      if (total_cost(problem, next) < linear.cost) {
        result.states = std::move(next);
        linear = linearise(problem, result.states);
        damping = damping > params.first_damping ? damping / params.damping_factor : 0;
        continue;
      }
    }
    damping = damping > 0 ? damping * params.damping_factor : params.first_damping;
  }
  return result;
}

}  // namespace

Block ChainCovariance::between(std::size_t i, std::size_t j) const {
  RADIOSLAM_CHECK(i <= j && j < size(), "states of the chain, in order");
  Block block = of_states_[j];
  for (std::size_t k = j; k-- > i;) block = (by_next_[k] * block).eval();
  return block;
}

std::optional<ChainFactor> ChainFactor::compute(const ChainMatrix& matrix, double damping) {
  ChainFactor factor;
  factor.lower_.reserve(matrix.diagonal.size());
  factor.coupling_.reserve(matrix.below.size());
  for (std::size_t k = 0; k < matrix.diagonal.size(); ++k) {
    Block rest = matrix.diagonal[k];
    rest.diagonal() *= 1 + damping;
    if (k > 0) {
      factor.coupling_.push_back(
          lower(factor.lower_.back()).solve(matrix.below[k - 1].transpose()).transpose());
      rest.noalias() -= factor.coupling_.back() * factor.coupling_.back().transpose();
    }
    const Cholesky<Block> cholesky(rest);
    if (!cholesky.succeeded()) return std::nullopt;
    factor.lower_.push_back(cholesky.lower());
  }
  return factor;
}

std::vector<InertialState::Tangent> ChainFactor::solve(std::vector<InertialState::Tangent> b) const {
  for (std::size_t k = 0; k < b.size(); ++k) {
    if (k > 0) b[k] -= coupling_[k - 1] * b[k - 1];
    lower(lower_[k]).solveInPlace(b[k]);
  }
  for (std::size_t k = b.size(); k-- > 0;) {
    if (k + 1 < b.size()) b[k] -= coupling_[k].transpose() * b[k + 1];
    lower_[k].transpose().triangularView<Eigen::Upper>().solveInPlace(b[k]);
  }
  return b;
}

ChainCovariance ChainFactor::covariance() const {
  std::vector<Block> of_states(lower_.size()), by_next(coupling_.size());
  for (std::size_t k = lower_.size(); k-- > 0;) {
    const Block inverse = lower(lower_[k]).solve(Block::Identity());
    of_states[k] = inverse.transpose() * inverse;
    if (k == coupling_.size()) continue;
    by_next[k] = -inverse.transpose() * coupling_[k].transpose();
    of_states[k] += by_next[k] * of_states[k + 1] * by_next[k].transpose();
  }
  return {std::move(of_states), std::move(by_next)};
}

UncertainPose<SE3> InertialTrajectory::relative_pose(std::size_t i, std::size_t j) const {
  const SE3 T_i_j = states[i].T_world_body.inverse() * states[j].T_world_body;
  if (i == j) return {T_i_j};
  const SE3::Jacobian by_i = -T_i_j.inverse().adjoint();
  const SE3::Jacobian of_i = covariance.of(i).topLeftCorner<6, 6>();
  const SE3::Jacobian of_j = covariance.of(j).topLeftCorner<6, 6>();
  const SE3::Jacobian cross = by_i * covariance.between(i, j).topLeftCorner<6, 6>();
  return {T_i_j, by_i * of_i * by_i.transpose() + cross + cross.transpose() + of_j};
}

StatePrior start_prior(const InertialState& start, const MapPose& pose, const ImuNoiseParams& noise,
                       const InertialSmootherParams& params) {
  const auto information = [](double sigma) { return 1 / (sigma * sigma); };
  const double tilt = information(params.sigma_start_tilt_rad);
  const Eigen::Matrix3d R = start.T_world_body.rotation_matrix();
  const Eigen::Vector3d about_world(tilt, tilt, information(params.sigma_start_yaw_rad));
  StatePrior prior{start};
  auto diagonal = prior.information.diagonal();
  diagonal.head<3>().setConstant(information(params.sigma_start_m));
  prior.information.block<3, 3>(3, 3) = R.transpose() * about_world.asDiagonal() * R;
  diagonal.segment<3>(InertialState::kVelocity).setConstant(information(params.sigma_start_velocity_mps));
  diagonal.segment<3>(InertialState::kGyroscope).setConstant(information(noise.sigma_gyroscope_bias_radps));
  diagonal.segment<3>(InertialState::kAccelerometer)
      .setConstant(information(noise.sigma_accelerometer_bias_mps2));
  auto map = diagonal.segment<6>(InertialState::kMap);
  map.head<3>().setConstant(information(params.sigma_start_map_m));
  map.tail<3>().setConstant(information(params.sigma_start_map_rad));
  prior.mean.T_map_world = pose.T_map_body * start.T_world_body.inverse();
  Eigen::Matrix<double, 6, InertialState::kDof> by_state;
  by_state.setZero();
  by_state.leftCols<6>().setIdentity();
  by_state.middleCols<6>(InertialState::kMap) = start.T_world_body.inverse().adjoint();
  prior.information += by_state.transpose() * pose.information * by_state;
  return prior;
}

std::optional<InertialTrajectory> smooth_inertially(const InertialDrive& drive,
                                                    const std::vector<ImuSample>& samples,
                                                    const ImuNoiseParams& noise,
                                                    const InertialSmootherParams& params) {
  RADIOSLAM_CHECK(!drive.stamps.empty() && drive.poses.size() == drive.stamps.size() &&
                      drive.map_drifts.size() + 1 == drive.stamps.size(),
                  "one pose per state and one map drift per step");
  ChainProblem problem{
      start_prior(drive.start, drive.poses.front(), noise, params), {}, drive, samples, noise};
  auto states = pass_forward(problem);
  if (!states) return std::nullopt;
  Minimum minimum = minimise(problem, std::move(*states), params);
  for (std::size_t k = 0; k < problem.steps.size(); ++k)
    problem.steps[k] = problem.step_for(k, minimum.states[k].bias);
  const int before = minimum.iterations;
  minimum = minimise(problem, std::move(minimum.states), params);
  const LinearChain linear = linearise(problem, minimum.states);
  const auto factor = ChainFactor::compute(linear.matrix, 0);
  if (!factor) return std::nullopt;
  return InertialTrajectory{drive.stamps, std::move(minimum.states),   factor->covariance(),
                            linear.cost,  before + minimum.iterations, minimum.converged};
}

}  // namespace radioslam

#include "radioslam/inertial/state_factors.hpp"

#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr int kPosition = Preintegration::kPosition, kRotation = Preintegration::kRotation,
              kVelocity = Preintegration::kVelocity;
constexpr int kTurn = 3;  // offset of the rotation in a state's tangent

/// The free motion from one state to the other.
FreeMotion motion_between(const InertialState& i, const InertialState& j, double t,
                          const Eigen::Vector3d& gravity) {
  const Eigen::Quaterniond back = i.T_world_body.rotation().conjugate();
  const Eigen::Vector3d offset = j.T_world_body.translation() - i.T_world_body.translation();
  return {t, back * (offset - t * i.velocity_mps - 0.5 * t * t * gravity), back * j.T_world_body.rotation(),
          back * (j.velocity_mps - i.velocity_mps - t * gravity)};
}

InertialResidual difference(const FreeMotion& actual, const FreeMotion& measured) {
  InertialResidual r;
  r << actual.position_m - measured.position_m, so3_log(measured.rotation.conjugate() * actual.rotation),
      actual.velocity_mps - measured.velocity_mps;
  return r;
}

/// Derivative of the residual by the bias of the first state, through the measured motion.
Eigen::Matrix<double, 9, 6> by_bias(const InertialResidual& residual, const Preintegration& measured,
                                    const InertialBias& bias) {
  Eigen::Matrix<double, 6, 1> change;
  change << bias.gyroscope_radps - measured.bias.gyroscope_radps,
      bias.accelerometer_mps2 - measured.bias.accelerometer_mps2;
  const Eigen::Vector3d turned = measured.bias_jacobian.middleRows<3>(kRotation) * change;
  const Eigen::Vector3d r = residual.segment<3>(kRotation);
  Eigen::Matrix<double, 9, 6> jacobian = -measured.bias_jacobian;
  jacobian.middleRows<3>(kRotation) = so3_left_jacobian_inverse(-r) * so3_exp(-r).toRotationMatrix() *
                                      so3_left_jacobian(-turned) * jacobian.middleRows<3>(kRotation).eval();
  return jacobian;
}

constexpr int kVelocityAt = InertialState::kVelocity, kBiasAt = InertialState::kGyroscope,
              kMapAt = InertialState::kMap;

using BiasChange = Eigen::Matrix<double, 6, 1>;
using PoseByState = Eigen::Matrix<double, 6, InertialState::kDof>;

BiasChange bias_between(const InertialState& i, const InertialState& j) {
  BiasChange change;
  change << j.bias.gyroscope_radps - i.bias.gyroscope_radps,
      j.bias.accelerometer_mps2 - i.bias.accelerometer_mps2;
  return change;
}

BiasChange bias_information(double duration_s, const ImuNoiseParams& noise) {
  BiasChange information;
  information.head<3>().setConstant(1 / (noise.gyroscope_walk * noise.gyroscope_walk * duration_s));
  information.tail<3>().setConstant(1 / (noise.accelerometer_walk * noise.accelerometer_walk * duration_s));
  return information;
}

double velocity_information(const StateStep& step, const ImuNoiseParams& params) {
  if (step.readings) return 0;
  return 1 / (params.unmeasured_velocity_walk * params.unmeasured_velocity_walk * step.duration_s);
}

SE3::Tangent pose_residual(const MapPose& measured, const InertialState& state) {
  return (measured.T_map_body.inverse() * state.T_map_world * state.T_world_body).log();
}

SE3::Tangent drift_residual(const InertialState& i, const InertialState& j) {
  const SE3& T = i.T_world_body;
  return (T.inverse() * i.T_map_world.inverse() * j.T_map_world * T).log();
}

/// Robust cost of a squared norm, and the weight of its residual.
struct Robust {
  double cost = 0, weight = 1;
};

Robust robust(double squared_norm, double outlier_sigmas) {
  const double ratio = squared_norm / (outlier_sigmas * outlier_sigmas);
  if (!(ratio > 1)) return {squared_norm, 1};
  return {squared_norm / ratio * (1 + std::log(ratio)), 1 / ratio};
}

/// Adds the squared norm of J_i x_i + J_j x_j + r.
template <class Residual, class ByState, class Information>
void add_squared_norm(StepTerms& sum, const Residual& r, const ByState& by_i, const ByState& by_j,
                      const Information& information) {
  const auto weighted_i = (information * by_i).eval();
  const auto weighted_j = (information * by_j).eval();
  const auto weighted_r = (information * r).eval();
  sum.i_i.noalias() += by_i.transpose() * weighted_i;
  sum.j_i.noalias() += by_j.transpose() * weighted_i;
  sum.j_j.noalias() += by_j.transpose() * weighted_j;
  sum.slope_i.noalias() += by_i.transpose() * weighted_r;
  sum.slope_j.noalias() += by_j.transpose() * weighted_r;
  sum.cost += r.dot(weighted_r);
}

void add_map_pose(StepTerms& sum, const MapPose& measured, const InertialState& state) {
  const SE3::Tangent r = pose_residual(measured, state);
  PoseByState by_state = PoseByState::Zero();
  by_state.leftCols<6>() = SE3::right_jacobian_inverse(r);
  by_state.middleCols<6>(kMapAt) = by_state.leftCols<6>() * state.T_world_body.inverse().adjoint();
  const double s = r.dot(measured.information * r);
  const Robust counted = robust(s, measured.outlier_sigmas);
  const SE3::Jacobian information = counted.weight * measured.information;
  const auto weighted = (information * by_state).eval();
  sum.j_j.noalias() += by_state.transpose() * weighted;
  sum.slope_j.noalias() += weighted.transpose() * r;
  sum.cost += counted.cost;
}

void add_map_drift(StepTerms& sum, const SE3::Jacobian& information, const InertialState& i,
                   const InertialState& j) {
  const SE3::Tangent r = drift_residual(i, j);
  const SE3::Jacobian after = SE3::right_jacobian_inverse(r), before = SE3::right_jacobian_inverse(-r);
  const SE3::Jacobian to_body = i.T_world_body.inverse().adjoint();
  PoseByState by_i = PoseByState::Zero(), by_j = PoseByState::Zero();
  by_i.leftCols<6>() = after - before;
  by_i.middleCols<6>(kMapAt) = -before * to_body;
  by_j.middleCols<6>(kMapAt) = after * to_body;
  add_squared_norm(sum, r, by_i, by_j, information);
}

/// Adds a difference `change` of the two states in the components from `first` on, with diagonal information.
template <class Vector>
void add_difference(StepTerms& sum, int first, const Vector& change, const Vector& information) {
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const Eigen::Index at = first + k;
    sum.i_i(at, at) += information[k];
    sum.j_j(at, at) += information[k];
    sum.j_i(at, at) -= information[k];
    sum.slope_i[at] -= information[k] * change[k];
    sum.slope_j[at] += information[k] * change[k];
    sum.cost += information[k] * change[k] * change[k];
  }
}

StepTerms no_terms() {
  const InertialState::Jacobian block = InertialState::Jacobian::Zero();
  const InertialState::Tangent slope = InertialState::Tangent::Zero();
  return {block, block, block, slope, slope, 0};
}

}  // namespace

InertialResidual inertial_residual(const InertialState& i, const InertialState& j,
                                   const Preintegration& measured, const ImuNoiseParams& params) {
  return difference(motion_between(i, j, measured.motion.duration_s, params.gravity()),
                    measured.with_bias(i.bias));
}

LinearInertialFactor linearise_inertial(const InertialState& i, const InertialState& j,
                                        const Preintegration& measured, const ImuNoiseParams& params) {
  const double t = measured.motion.duration_s;
  const FreeMotion actual = motion_between(i, j, t, params.gravity());
  const Eigen::Matrix3d back = i.T_world_body.rotation_matrix().transpose();
  const Eigen::Matrix3d R_i_j = actual.rotation.toRotationMatrix();

  LinearInertialFactor f{difference(actual, measured.with_bias(i.bias)), InertialResidualByState::Zero(),
                         InertialResidualByState::Zero()};
  const Eigen::Matrix3d from_turn = so3_left_jacobian_inverse(-f.residual.segment<3>(kRotation));
  f.by_i.block<3, 3>(kPosition, 0) = -Eigen::Matrix3d::Identity();
  f.by_i.block<3, 3>(kPosition, kTurn) = skew(actual.position_m);
  f.by_i.block<3, 3>(kPosition, InertialState::kVelocity) = -t * back;
  f.by_i.block<3, 3>(kRotation, kTurn) = -from_turn * R_i_j.transpose();
  f.by_i.block<3, 3>(kVelocity, kTurn) = skew(actual.velocity_mps);
  f.by_i.block<3, 3>(kVelocity, InertialState::kVelocity) = -back;
  f.by_i.middleCols<6>(InertialState::kGyroscope) = by_bias(f.residual, measured, i.bias);

  f.by_j.block<3, 3>(kPosition, 0) = R_i_j;
  f.by_j.block<3, 3>(kRotation, kTurn) = from_turn;
  f.by_j.block<3, 3>(kVelocity, InertialState::kVelocity) = back;
  return f;
}

StateStep state_step(const MapPose& pose, const SE3::Jacobian& map_drift,
                     std::optional<Preintegration> readings, double duration_s) {
  StateStep step{pose, inverse(map_drift), std::move(readings), Preintegration::Covariance::Zero(),
                 duration_s};
  if (step.readings) step.imu_information = inverse(step.readings->covariance);
  return step;
}

double cost_of(const StatePrior& prior, const InertialState& state) {
  const InertialState::Tangent r = prior.mean.step_to(state);
  return r.dot(prior.information * r);
}

double cost_of(const StateStep& step, const InertialState& i, const InertialState& j,
               const ImuNoiseParams& params) {
  const SE3::Tangent r = pose_residual(step.pose, j), drift = drift_residual(i, j);
  const BiasChange walk = bias_between(i, j);
  double cost = robust(r.dot(step.pose.information * r), step.pose.outlier_sigmas).cost +
                drift.dot(step.map_information * drift) +
                walk.dot(bias_information(step.duration_s, params).cwiseProduct(walk));
  if (step.readings) {
    const InertialResidual inertial = inertial_residual(i, j, *step.readings, params);
    return cost + inertial.dot(step.imu_information * inertial);
  }
  return cost + velocity_information(step, params) * (j.velocity_mps - i.velocity_mps).squaredNorm();
}

PriorTerms linearise(const StatePrior& prior, const InertialState& state) {
  const InertialState::Tangent r = prior.mean.step_to(state);
  InertialState::Jacobian by_state = InertialState::Jacobian::Identity();
  by_state.topLeftCorner<6, 6>() = SE3::right_jacobian_inverse(r.head<6>());
  by_state.block<6, 6>(kMapAt, kMapAt) = SE3::right_jacobian_inverse(r.segment<6>(kMapAt));
  const InertialState::Jacobian weighted = by_state.transpose() * prior.information;
  return {weighted * by_state, weighted * r, r.dot(prior.information * r)};
}

StepTerms linearise(const StateStep& step, const InertialState& i, const InertialState& j,
                    const ImuNoiseParams& params) {
  StepTerms sum = no_terms();
  if (!step.pose.information.isZero(0)) add_map_pose(sum, step.pose, j);
  add_map_drift(sum, step.map_information, i, j);
  if (step.readings) {
    const LinearInertialFactor f = linearise_inertial(i, j, *step.readings, params);
    add_squared_norm(sum, f.residual, f.by_i, f.by_j, step.imu_information);
  } else {
    const double information = velocity_information(step, params);
    add_difference(sum, kVelocityAt, Eigen::Vector3d(j.velocity_mps - i.velocity_mps),
                   Eigen::Vector3d(Eigen::Vector3d::Constant(information)));
  }
  add_difference(sum, kBiasAt, bias_between(i, j), bias_information(step.duration_s, params));
  return sum;
}

}  // namespace radioslam

#include "radioslam/inertial/inertial_factor.hpp"

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

}  // namespace radioslam

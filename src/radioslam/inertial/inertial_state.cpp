#include "radioslam/inertial/inertial_state.hpp"

namespace radioslam {

InertialState InertialState::moved_by(const Tangent& step) const {
  return {T_world_body * SE3::exp(step.head<SE3::kDof>()),
          velocity_mps + step.segment<3>(kVelocity),
          {bias.gyroscope_radps + step.segment<3>(kGyroscope),
           bias.accelerometer_mps2 + step.segment<3>(kAccelerometer)},
          T_map_world * SE3::exp(step.segment<SE3::kDof>(kMap))};
}

InertialState::Tangent InertialState::step_to(const InertialState& there) const {
  Tangent step;
  step << (T_world_body.inverse() * there.T_world_body).log(), there.velocity_mps - velocity_mps,
      there.bias.gyroscope_radps - bias.gyroscope_radps,
      there.bias.accelerometer_mps2 - bias.accelerometer_mps2,
      (T_map_world.inverse() * there.T_map_world).log();
  return step;
}

}  // namespace radioslam

#include "radioslam/inertial/motion_prediction.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/inertial/imu_intervals.hpp"

namespace radioslam {

InertialState state_after(const InertialState& state, const FreeMotion& motion,
                          const ImuNoiseParams& params) {
  const SE3& T = state.T_world_body;
  const double t = motion.duration_s;
  const Eigen::Vector3d g = params.gravity();
  const Eigen::Vector3d position =
      T.translation() + t * state.velocity_mps + 0.5 * t * t * g + T.rotate(motion.position_m);
  return {SE3(position, T.rotation() * motion.rotation),
          state.velocity_mps + t * g + T.rotate(motion.velocity_mps), state.bias, state.T_map_world};
}

std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<ImuSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const ImuNoiseParams& params) {
  std::vector<InertialState> states;
  FreeMotion motion;
  Stamp reached = start;
  for (const Stamp stamp : stamps) {
    RADIOSLAM_CHECK(reached <= stamp, "the times do not decrease");
    const auto intervals = imu_intervals(samples, reached, stamp, params.max_gap_s);
    if (!intervals) return std::nullopt;
    for (const ImuInterval& interval : *intervals)
      motion.append(interval.duration_s, interval.angular_rate_radps - state.bias.gyroscope_radps,
                    interval.specific_force_mps2 - state.bias.accelerometer_mps2);
    states.push_back(state_after(state, motion, params));
    reached = stamp;
  }
  return states;
}

}  // namespace radioslam

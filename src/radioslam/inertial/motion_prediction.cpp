#include "radioslam/inertial/motion_prediction.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/inertial/reading_intervals.hpp"

namespace radioslam {

InertialState state_after(const InertialState& state, const FreeMotion& motion,
                          const InertialNoiseParams& params) {
  const SE3& T = state.T_world_body;
  const double t = motion.duration_s;
  const Eigen::Vector3d g = params.gravity();
  const Eigen::Vector3d position =
      T.translation() + t * state.velocity_mps + 0.5 * t * t * g + T.rotate(motion.position_m);
  return {SE3(position, T.rotation() * motion.rotation),
          state.velocity_mps + t * g + T.rotate(motion.velocity_mps), state.bias, state.T_map_world};
}

std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<InertialSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const InertialNoiseParams& params) {
  std::vector<InertialState> states;
  FreeMotion motion;
  Stamp reached = start;
  for (const Stamp stamp : stamps) {
    RADIOSLAM_CHECK(reached <= stamp, "the times do not decrease");
    const auto pieces = reading_intervals(samples, reached, stamp, params.longest_gap_s);
    if (!pieces) return std::nullopt;
    for (const ReadingInterval& piece : *pieces)
      motion.append(piece.duration_s, piece.angular_rate_radps - state.bias.gyroscope_radps,
                    piece.specific_force_mps2 - state.bias.accelerometer_mps2);
    states.push_back(state_after(state, motion, params));
    reached = stamp;
  }
  return states;
}

}  // namespace radioslam

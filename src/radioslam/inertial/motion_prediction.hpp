// Where the body goes from a known state by its inertial readings alone: for taking the motion out of a scan,
// and as the first guess of the next pose.
//
//   p(t) = p + v t + g t^2 / 2 + R position,  v(t) = v + g t + R velocity,  R(t) = R rotation
//
// with the free motion of preintegration.hpp. Refuses where the readings leave too long a gap.
// Cost: readings between the start and the last time, a binary search per time.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

/// The state after a free motion from `state`; the biases stay.
InertialState state_after(const InertialState& state, const FreeMotion& motion,
                          const InertialNoiseParams& params);

/// The states at these times, which do not decrease and are not before `start`, when `state` holds.
std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<InertialSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const InertialNoiseParams& params);

}  // namespace radioslam

// Predicts a body's motion from a known state by IMU samples alone, for deskewing and as an initial pose.
//
//   p(t) = p + v t + g t^2 / 2 + R position,  v(t) = v + g t + R velocity,  R(t) = R rotation
//
// with the free motion of preintegration.hpp. Refuses gaps in the samples longer than `max_gap_s`.
// Cost: samples between the start and the last time, and a binary search per time.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

/// The state after a free motion from `state`; the biases stay the same.
InertialState state_after(const InertialState& state, const FreeMotion& motion, const ImuNoiseParams& params);

/// The states at `stamps`, which do not decrease and are not before `start`, the time of `state`.
std::optional<std::vector<InertialState>> predict_motion(const InertialState& state, Stamp start,
                                                         const std::vector<ImuSample>& samples,
                                                         const std::vector<Stamp>& stamps,
                                                         const ImuNoiseParams& params);

}  // namespace radioslam

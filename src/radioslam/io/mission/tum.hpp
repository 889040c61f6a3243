// Reads and writes trajectories in the TUM format: one pose per line, `t x y z qx qy qz qw`, seconds and
// metres, '#' comments. Stamps are exact to the nanosecond in both directions; quaternions, which must be
// near unit length, are normalised on reading.
#pragma once

#include <string>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Refuses (InputError) times that do not increase, quaternions whose norm differs from 1 by more than
/// kUnitQuaternionTolerance, and a text without poses.
Trajectory<SE3> read_tum(const Text& text);

std::string format_tum(const Trajectory<SE3>& trajectory);

}  // namespace radioslam

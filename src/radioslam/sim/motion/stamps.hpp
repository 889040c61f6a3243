// Stamps of recordings at a given rate, in whole milliseconds, and names of robots.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// Stamps from `begin_s` to `end_s` at a rate.
std::vector<Stamp> regular_stamps(double begin_s, double end_s, double rate_hz);

/// Lifts planar poses, one per stamp, to a trajectory in space.
Trajectory<SE3> lifted(const std::vector<Stamp>& stamps, const std::vector<SE2>& poses);

/// a, b, ..., z, a1, b1, ...
std::string robot_id(std::size_t index);

}  // namespace radioslam

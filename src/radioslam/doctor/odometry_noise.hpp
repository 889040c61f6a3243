// Process noise of odometry as its own steps show it, against the stated sigma_xy_per_sqrt_m.
//
// Sideways motion of a body is smooth, the odometry's noise is independent from step to step. The difference
// D of the sideways motions in two adjacent windows of m steps has variance 2 m sigma^2 for independent
// noise, the same for every m for errors about each pose, and grows as m^4 for smooth motion: only where
// median(D^2) / path is alike for m = 1, 2, 4 is it the random walk that the sigma describes. What a step
// goes sideways because it turns (proportional to its length times its turn) is removed before.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Measured sigma of a random walk in y of the body, per square root of a metre. Nothing where steps are
/// rarer than twice a second, fewer than 200 move, or their noise is not that of a random walk.
std::optional<double> measured_sigma_xy_per_sqrt_m(const Trajectory<SE3>& odometry);

/// Findings about robots whose measured noise is more than five times the stated one. Noise recorded with the
/// steps is not checked.
std::vector<Finding> check_odometry_noise(const Mission& mission);

}  // namespace radioslam

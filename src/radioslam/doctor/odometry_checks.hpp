// What one robot's trajectory shows by itself: units, speeds, gaps, order of columns, handedness.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Findings about every robot with recorded odometry, and about robots with the same recording.
std::vector<Finding> check_odometry(const Mission& mission);

// Whether a robot's odometry covers the time in which its other sensors and its links recorded.

/// A finding per robot whose odometry leaves out more than a quarter of a recording of ten rows or more, and
/// more than twenty seconds. Holes within the odometry are check_odometry's.
std::vector<Finding> check_odometry_coverage(const Mission& mission);

}  // namespace radioslam

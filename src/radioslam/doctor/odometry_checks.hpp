// What one robot's trajectory shows by itself: units, speeds, gaps, order of columns, handedness.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Findings about every robot with recorded odometry, and about robots with the same recording.
std::vector<Finding> check_odometry(const Mission& mission);

}  // namespace radioslam

// Whether the recordings of a mission belong together: clocks, gaps, amounts, links between the robots.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// The times of every file against those of the robot's odometry (or scans).
std::vector<Finding> check_times(const Mission& mission);

/// Robots that nothing ties to the others.
std::vector<Finding> check_connections(const Mission& mission);

}  // namespace radioslam

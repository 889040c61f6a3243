// Whether a trajectory is in the frame that a mission asks for: right-handed, z up, quaternions with qw last,
// from the robot's start.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds findings about a robot with odometry.
void check_frame(const Mission& mission, const Robot& robot, std::vector<Finding>& findings);

}  // namespace radioslam

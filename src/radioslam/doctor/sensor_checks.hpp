// What the recordings of single sensors show: units, repeated rows, spellings, moving access points, and
// whether an IMU turns as the odometry does.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

std::vector<Finding> check_wifi(const Mission& mission);
std::vector<Finding> check_inertial(const Mission& mission);
/// Reads a few scans of every robot.
std::vector<Finding> check_scans(const Mission& mission);

}  // namespace radioslam

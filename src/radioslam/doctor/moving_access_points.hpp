// Access points that move: carried by the robot itself, or heard with strengths that no fixed place explains.
#pragma once

#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds a finding for every such access point in the robot's scans. `track`: its dead reckoning.
void check_access_points(const Mission& mission, const Robot& robot, const Track& track,
                         std::vector<Finding>& findings);

}  // namespace radioslam

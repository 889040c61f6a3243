// Whether a robot's fingerprints are on the clock of its odometry: similar scans should come from near
// places.
#pragma once

#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds a finding if the correlation of similarity and nearness is clearly greater for scans that are shifted
/// in time by two seconds or more. `track`: the robot's dead reckoning. Turns, stops and revisits show a
/// shift; a straight path at constant speed does not.
void check_fingerprint_clock(const Robot& robot, const Track& track, std::vector<Finding>& findings);

}  // namespace radioslam

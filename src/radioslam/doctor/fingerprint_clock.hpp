// Whether a robot's fingerprints are on the clock of its odometry: how similar two scans are should depend on
// how far apart the odometry has them.
//
// For every lag of the scans, similarity is fitted by a step function of distance; the lag with the least sum
// of squares is the likeliest. Turns, stops and places passed in both directions make distances depend on the
// lag; a straight path at constant speed does not. Pairs of scans share noise, so the gain over no lag must
// be found in most stretches of the recording, besides being large.
#pragma once

#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds a finding if a lag of two seconds or more explains similarity clearly better than none
/// does. `track`: the robot's dead reckoning.
void check_fingerprint_clock(const Robot& robot, const Track& track, std::vector<Finding>& findings);

}  // namespace radioslam

// WiFi scans that repeat older ones: readings that a phone or driver kept and listed again while the robot
// moved on.
//
// A reading in two scans at different places has the same value by chance; levels are whole dBm, so chance is
// not rare. Whole scans: with probability p of one equal reading, which the other pairs of scans show, a scan
// of n readings has at least 0.9 n equal ones with the tail of Bin(n, p); the number of repeats is tested
// against the sum of those (Poisson, Chernoff bound). Single readings: differences between scans have a
// smooth density, so that the number of zeros follows from those of one and two steps as of a Gaussian; kept
// readings add zeros to it.
#pragma once

#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds at most one finding. Scans are compared with the twelve before, at places a metre or more apart by
/// the dead reckoning `track`; a robot that stands still, or scans of fewer than five readings, show
/// nothing.
void check_stale_scans(const Robot& robot, const Track& track, std::vector<Finding>& findings);

}  // namespace radioslam

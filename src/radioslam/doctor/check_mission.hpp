// Plausibility of a mission before anything is estimated: units, clocks, frames, starts, gaps, repetitions,
// and whether radio, dead reckoning and the other sensors can be true together.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// Errors first, each list in the order of the checks. Deterministic. Work is bounded: a few windows of links
/// are fitted, and a few scans read.
std::vector<Finding> check_mission(const Mission& mission);

/// Where ground truth contradicts the odometry (clock, unit, mirror image, another robot's, a pose that
/// stops), and where stated starts and ranges between robots contradict the truth.
std::vector<Finding> check_truth(const Mission& mission, const Truth& truth);

}  // namespace radioslam

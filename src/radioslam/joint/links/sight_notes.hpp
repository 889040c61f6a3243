// Notes on robots whose radio links are nearly all obstructed: their place rests on detours.
#pragma once

#include <string>
#include <vector>

#include "radioslam/results/results.hpp"

namespace radioslam {

/// One note for each placed robot of unknown start that has links with other robots, hardly any of them
/// accepted, and no other closure with another robot.
std::vector<std::string> notes_on_obstructed_robots(const std::vector<RobotResult>& robots,
                                                    const std::vector<ClosureResult>& closures);

}  // namespace radioslam

// A run as the team that its truth judges: robots that stand in another frame than the first component's, or
// in none, have no poses to compare.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// The trajectories to compare with the truth: the team has one frame, so robots of other components, and
/// robots that nothing ties to theirs, count as not covered.
std::vector<EstimatedTrajectory> in_common_frame(std::vector<EstimatedTrajectory> robots,
                                                 const std::vector<Component>& components,
                                                 const std::vector<std::string>& unplaced);

/// The trajectories of a run, or of one of its alternatives.
std::vector<EstimatedTrajectory> team_estimate(const std::vector<RobotResult>& robots,
                                               const RunResult& result);
std::vector<EstimatedTrajectory> team_estimate(const RunResult& result);

/// Does a robot stand outside of the first component?
bool is_elsewhere(const std::string& id, const std::vector<Component>& components);

}  // namespace radioslam

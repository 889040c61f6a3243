// Selects the trajectories of a run that can be compared with the truth: robots in another frame than the
// first component's, and unplaced robots, have no poses to compare.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Trajectories to compare with the truth. Robots of other components and unplaced robots are returned empty,
/// so that they count as not covered.
std::vector<EstimatedTrajectory> in_common_frame(std::vector<EstimatedTrajectory> robots,
                                                 const std::vector<Component>& components,
                                                 const std::vector<std::string>& unplaced);

/// The trajectories of a run, or of one of its alternative hypotheses.
std::vector<EstimatedTrajectory> team_estimate(const std::vector<RobotResult>& robots,
                                               const RunResult& result);
std::vector<EstimatedTrajectory> team_estimate(const RunResult& result);

/// Whether a robot is outside the first component.
bool is_elsewhere(const std::string& id, const std::vector<Component>& components);

}  // namespace radioslam

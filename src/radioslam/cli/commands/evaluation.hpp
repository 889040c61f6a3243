// Text output for an evaluation against ground truth: notes, dead reckoning as a baseline, table of errors.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// One note for each robot that is not in the frame of the first component.
std::vector<std::string> frame_notes(const std::vector<EstimatedTrajectory>& robots,
                                     const std::vector<Component>& components,
                                     const std::vector<std::string>& unplaced);

/// Trajectories from odometry alone, beginning at the known starts; empty unless every start is known.
std::vector<EstimatedTrajectory> dead_reckoning(const Mission& mission);

/// Table of position errors per robot and for the team, and the relative error.
std::string metrics_table(const TeamMetrics& metrics);

}  // namespace radioslam::cli

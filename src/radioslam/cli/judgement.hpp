// What an estimate is worth against the truth, in words and lines to read.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// One line for each robot that is known not to share the first component's frame.
std::vector<std::string> frame_notes(const std::vector<EstimatedTrajectory>& robots,
                                     const std::vector<Component>& components,
                                     const std::vector<std::string>& unplaced);

/// The odometry alone, from the known starts; empty unless every start is known.
std::vector<EstimatedTrajectory> dead_reckoning(const Mission& mission);

/// Metrics in lines to read: the team, each robot, relative errors.
std::string metrics_table(const TeamMetrics& metrics);

}  // namespace radioslam::cli

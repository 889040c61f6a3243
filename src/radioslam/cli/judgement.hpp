// What an estimate is worth against the truth: which trajectories can be compared, and the comparison.
// Robots of different components have no common frame. Those outside the first component that has poses, and
// those that nothing ties to it, count as not covered.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// `robots` with the poses of those that share the first component's frame; all of them when no components
/// are known.
std::vector<EstimatedTrajectory> in_common_frame(std::vector<EstimatedTrajectory> robots,
                                                 const std::vector<Component>& components,
                                                 const std::vector<std::string>& unplaced);

/// One line for each robot that is known not to share the first component's frame.
std::vector<std::string> frame_notes(const std::vector<EstimatedTrajectory>& robots,
                                     const std::vector<Component>& components,
                                     const std::vector<std::string>& unplaced);

/// The estimate of a run.
std::vector<EstimatedTrajectory> team_estimate(const RunResult& result);

/// The odometry alone, from the known starts; empty unless every start is known.
std::vector<EstimatedTrajectory> dead_reckoning(const Mission& mission);

/// Metrics in lines to read: the team, each robot, relative errors.
std::string metrics_table(const TeamMetrics& metrics);

}  // namespace radioslam::cli

// Trajectories corrected by their own loops, before robots are aligned: with a graduated truncated loss,
// which rejects loops that neither the odometry nor the other loops of the trajectory support.
#pragma once

#include <memory>
#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/team_loops.hpp"

namespace radioslam {

/// Moves the poses of every segment to the robust optimum of its odometry and its own loops, in its own
/// frame, and sets which of these loops are accepted.
template <class Pose>
void correct_by_own_loops(JointGraph<Pose>& joint, std::vector<TeamLoop<Pose>>& loops,
                          const OptimizerParams& optimizer);

/// Per segment.
template <class Pose>
using SegmentChains = std::vector<std::unique_ptr<PoseChain<Pose>>>;

/// Every segment as a chain between the ends of loops: by odometry where it has no accepted loop of its own,
/// else corrected by these. The odometry's standard deviations are taken times `odometry_scale`. Cost: a
/// solve per end of a loop on corrected segments.
template <class Pose>
SegmentChains<Pose> segment_chains(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                                   double odometry_scale);

}  // namespace radioslam

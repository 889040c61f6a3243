// Poses at further stamps of a joint graph that exists already, for closures that come late.
//
// A new pose divides the odometry edge that it lies on into two, each with its own noise; every other factor,
// weight and value stays. So a graph that was extended has the optimum of one that was built with these
// poses. The poses of a graph file are all there are: its robots have no odometry between them.
#pragma once

#include <vector>

#include "radioslam/joint/team_estimate.hpp"

namespace radioslam {

/// `stamps`: per robot. Those at which there is a pose, or that the odometry does not cover, are ignored.
/// Alternatives get the same poses.
template <class Pose>
void add_nodes(TeamEstimate<Pose>& team, const Mission& mission, const JointGraphParams& params,
               const std::vector<std::vector<Stamp>>& stamps);

}  // namespace radioslam

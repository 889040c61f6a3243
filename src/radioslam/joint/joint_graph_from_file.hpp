// Joint graph of a team that is read from a factor graph file: every pose is a keyframe.
#pragma once

#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// `mission` contains the team's robots with their sensors, in the order of their first segments.
/// Information matrices are those of the logarithm, whatever the file's chart.
template <class Pose>
JointGraph<Pose> joint_graph_of(const TeamGraph<Pose>& team, const Mission& mission);

/// The relative poses of the team that are not odometry, in the order of the file.
template <class Pose>
std::vector<Closure> closures_of(const TeamGraph<Pose>& team, const JointGraph<Pose>& joint);

}  // namespace radioslam

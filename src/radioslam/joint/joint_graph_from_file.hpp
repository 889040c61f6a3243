// Joint graph of a team that is read from a factor graph file: every pose is a keyframe.
#pragma once

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// `mission` contains the team's robots with their sensors, in the order of their first segments.
/// Relative-pose factors between segments do not place robots yet; they are counted in ignored_links.
template <class Pose>
JointGraph<Pose> joint_graph_of(const TeamGraph<Pose>& team, const Mission& mission);

}  // namespace radioslam

// The joint graph of a team that comes as a factor graph: every pose is a keyframe.
#pragma once

#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

/// `mission` has the team's robots, in the order of their first pieces, with their sensors. Ties between
/// pieces by relative poses do not place anybody yet; they are counted as ignored links.
template <class Pose>
JointGraph<Pose> joint_graph_of(const TeamGraph<Pose>& team, const Mission& mission);

}  // namespace radioslam

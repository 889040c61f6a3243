// Part of a team: some of its segments with everything measured within and between them.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

template <class Pose>
struct SubTeam {
  TeamGraph<Pose> team;               ///< drifts as in the whole team, no points
  std::vector<std::size_t> segments;  ///< of the whole team, in the order of team.segments
};

/// `segments`: ascending.
template <class Pose>
SubTeam<Pose> sub_team(const TeamGraph<Pose>& whole, std::vector<std::size_t> segments);

}  // namespace radioslam

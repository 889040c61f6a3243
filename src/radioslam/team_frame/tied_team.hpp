// The part of a team's measurements that hold where some pieces share a frame already and others do not:
// those whose ends share one. Poses, points and drifts stay as they are, so that values carry over.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// The pieces and points that share the frame of component `of_piece[p]`, `of_point[k]`; -1: alone.
struct TeamComponents {
  std::vector<int> of_piece, of_point;
};

template <class Pose>
struct TiedTeam {
  TeamGraph<Pose> team;
  std::vector<std::size_t> ranges, bearings;  ///< their places in the whole team's lists
};

/// The piece of every pose.
template <class Pose>
std::vector<std::size_t> piece_of_poses(const TeamGraph<Pose>& team);

/// Keeps the measurements within a piece and within a component.
template <class Pose>
TiedTeam<Pose> tied_team(const TeamGraph<Pose>& team, const TeamComponents& components);

}  // namespace radioslam

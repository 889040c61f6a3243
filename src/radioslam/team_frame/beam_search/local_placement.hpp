// Places a segment of a large team by its best-linked neighbours alone: the cost does not grow with the team.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/team_frame/beam_search/beam_selection.hpp"
#include "radioslam/team_frame/beam_search/radio_alignment_params.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {

// Part of a team: some of its segments with everything measured within and between them.

template <class Pose>
struct SubTeam {
  TeamGraph<Pose> team;               ///< drifts as in the whole team, no points
  std::vector<std::size_t> segments;  ///< of the whole team, in the order of team.segments
};

/// `segments`: ascending.
template <class Pose>
SubTeam<Pose> sub_team(const TeamGraph<Pose>& whole, std::vector<std::size_t> segments);

/// The team `at` with the unplaced `segment` in `component`, once for every alignment that its links with its
/// neighbours leave open. The evidence is that of `at` and what the part of the team, refined by itself,
/// gains by the segment; the other segments stay where they are.
template <class Pose>
std::vector<TeamValues<Pose>> place_locally(const TeamGraph<Pose>& team, const TeamComponents& components,
                                            int component, std::size_t segment, const TeamValues<Pose>& at,
                                            const RadioAlignmentParams& params);

}  // namespace radioslam

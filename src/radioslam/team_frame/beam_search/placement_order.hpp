// Order in which trajectory segments and points are placed: the one with the most links first, segments
// before points. Units with too few links to determine their pose are never chosen.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/team_frame/pose_proposals.hpp"

namespace radioslam {

/// Component of a segment or point that is not placed yet.
inline constexpr int kUnplaced = -1;

/// Segments, then points, without a component.
template <class Pose>
std::vector<UnplacedNode> unplaced_nodes(const TeamGraph<Pose>& team, const TeamComponents& components);

/// The unplaced segment with the most links to another unplaced segment or point, from which a component can
/// grow; nothing if none has enough links.
template <class Pose>
std::optional<std::size_t> next_root(const TeamGraph<Pose>& team, const TeamComponents& components);

/// The unit to be added to a component next; nothing if none has enough links to it.
template <class Pose>
std::optional<UnplacedNode> next_unit(const TeamGraph<Pose>& team, const TeamComponents& components,
                                      int component);

/// Numbers the components in the order of their first segments.
void renumber(TeamComponents& components);

}  // namespace radioslam

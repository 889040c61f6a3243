// Selects the measurements of a team whose ends already share a frame, while some trajectory segments are
// placed and others are not. Poses, points and drifts keep their indices, so that values carry over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// Component (common frame) of every segment and point; -1: not placed yet.
struct TeamComponents {
  std::vector<int> of_segment, of_point;
};

template <class Pose>
struct ConnectedTeam {
  TeamGraph<Pose> team;
  std::vector<std::size_t> ranges, bearings;  ///< indices in the whole team's lists
};

/// Segment index of every pose.
template <class Pose>
std::vector<std::size_t> segment_of_poses(const TeamGraph<Pose>& team);

/// The trajectory or point that an end of a measurement is on: the segment's index, or less than 0.
inline std::int64_t end_number(const std::vector<std::size_t>& segment_of, PoseId pose) {
  return static_cast<std::int64_t>(segment_of[pose.index()]);
}
template <class Pose>
std::int64_t end_number(const std::vector<std::size_t>& segment_of, const RangeEnd<Pose>& end) {
  return end.pose.valid() ? end_number(segment_of, end.pose) : -1 - std::int64_t{end.point.value};
}

/// Keeps the measurements within a segment or within a component.
template <class Pose>
ConnectedTeam<Pose> connected_team(const TeamGraph<Pose>& team, const TeamComponents& components);

}  // namespace radioslam

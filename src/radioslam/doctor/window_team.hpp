// A window of links as a team of two segments: the poses of both nodes at the links' times, their odometry
// with its stated noise, and the links. The world is a segment of one pose, its points are lever arms of it.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

template <class Pose>
struct WindowTeam {
  TeamGraph<Pose> team;  ///< segments of nodes i and j, each in its own frame
  /// log |d corrected / d recorded| of all ranges, and the log density of those without odometry at their
  /// time.
  double log_density = 0;
  std::size_t links = 0;  ///< of the window, unplaced ones included
};

template <class Pose>
WindowTeam<Pose> window_team(const TeamLinks& team, const LinkWindow& window);

}  // namespace radioslam

// Proposes where a piece of a trajectory, or a point, may lie in the frame of a component that it has links
// with: alignment grids from several reference links, well spread over all of them.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/team_frame/alignment_grid.hpp"
#include "radioslam/team_frame/tied_team.hpp"

namespace radioslam {

/// A place to start a refinement from.
struct Place {
  SE2 T_team_unit;  ///< moves the piece's (or the point's) values into the component's frame, seen from above
  double score = 0;     ///< comparable between places of one reference only
  Inflation inflation;  ///< over the whole team's ranges and bearings
};

/// What is to be placed.
struct Unit {
  bool is_piece = true;
  std::size_t index = 0;  ///< in TeamGraph::pieces or in graph.points
};

/// How many numbers the links between a component and a unit give.
template <class Pose>
std::size_t count_links(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                        const Unit& unit);

/// Places of `unit` in `component`: the best of every reference, then the second best of every one, ...
/// `weighted` is the tied team's graph with its values, weights and sigmas: it tells how certain the ways
/// between links are. Empty without links, and where the ways' covariances cannot be computed.
template <class Pose>
std::vector<Place> propose_places(const TeamGraph<Pose>& team, const TeamComponents& components,
                                  int component, const Unit& unit, const PoseGraph<Pose>& weighted,
                                  const MixtureParams& mixture, const GridParams& params);

}  // namespace radioslam

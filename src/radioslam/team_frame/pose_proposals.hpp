// Proposes start poses for a trajectory segment, or a point, in the frame of a component that it has links
// with: peaks of alignment grids (alignment_grid.hpp) from several reference links, evenly spread over all
// links.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/team_frame/alignment_grid.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {

/// Start pose for a refinement.
struct PoseProposal {
  SE2 T_team_unit;              ///< from the frame of the unit's values to the component's, seen from above
  double rise_m = 0;            ///< in space, how far the unit is raised
  double score = 0;             ///< comparable between proposals of one reference only
  VarianceInflation inflation;  ///< of all ranges and bearings of the team
};

/// Trajectory segment or point to be placed.
struct UnplacedNode {
  bool is_segment = true;
  std::size_t index = 0;  ///< in TeamGraph::pieces or in graph.points
};

/// Number of measurements between a component and a unit.
template <class Pose>
std::size_t count_links(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                        const UnplacedNode& unit);

/// Proposals for `unit` in `component`: the best of every reference, then the second best of each, and so on.
/// `weighted` is the connected team's graph with values, weights and sigmas, from which the covariances
/// between links are computed. Empty without links or if those covariances cannot be computed.
template <class Pose>
std::vector<PoseProposal> propose_poses(const TeamGraph<Pose>& team, const TeamComponents& components,
                                        int component, const UnplacedNode& unit,
                                        const PoseGraph<Pose>& weighted, const MixtureParams& mixture,
                                        const GridParams& params);

}  // namespace radioslam

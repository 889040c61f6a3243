// A team whose busiest pairs keep only as many links as a search needs.
#pragma once

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/team_frame/alignment_grid.hpp"

namespace radioslam {

/// At most GridParams::most_links ranges, and as many bearings, between two pieces or a piece and a point,
/// and most_sightings relative points; those kept are evenly spread.
template <class Pose>
TeamGraph<Pose> with_fewer_links(const TeamGraph<Pose>& team, const GridParams& params);

}  // namespace radioslam

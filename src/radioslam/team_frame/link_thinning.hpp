// Thins the links of a team so that no pair of segments holds more than the alignment search needs.
#pragma once

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/team_frame/alignment_grid.hpp"

namespace radioslam {

/// Keeps at most GridParams::max_links ranges, as many bearings, and max_sightings relative points between
/// two segments or a segment and a point, evenly spread; and as many fewer between the segments of a large
/// team as keep the ranges of a segment within max_links_of_robot, but eight of each pair.
template <class Pose>
TeamGraph<Pose> thin_links(const TeamGraph<Pose>& team, const GridParams& params);

}  // namespace radioslam

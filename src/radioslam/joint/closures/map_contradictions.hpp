// Groups of loops between two trajectories that the robots' scans contradict (joint/places/map_witness.hpp).
#pragma once

#include <vector>

#include "radioslam/joint/closures/loop_alignment.hpp"

namespace radioslam {

class MapWitness;

/// Without groups that could join robots but lay one's structure into the other's free space. `maps`: null
/// without scans.
template <class Pose>
std::vector<LoopGroup> held_against_maps(const MapWitness* maps, const std::vector<Closure>& closures,
                                         const std::vector<TeamLoop<Pose>>& loops,
                                         std::vector<LoopGroup> groups);

}  // namespace radioslam

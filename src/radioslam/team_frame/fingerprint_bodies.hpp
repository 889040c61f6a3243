// The team's odometries as rigid bodies, whose points are the places of fingerprints.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

/// Which of `count` nodes take part: all, or evenly thinned to `most` at the most.
std::vector<std::size_t> thinned_nodes(std::size_t count, int most);

/// A body per robot with its points among `nodes` (of RadioMeasurements::nodes, increasing); robots with an
/// initial pose are fixed there, the others lie in their own start frame.
std::vector<RigidBody> fingerprint_bodies(const Mission& mission, const RadioMeasurements& radio,
                                          const std::vector<std::size_t>& nodes);

}  // namespace radioslam

// The team's odometry trajectories as rigid bodies whose points are the fingerprints' positions.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

/// Indices of at most `most` of `count` nodes, evenly thinned.
std::vector<std::size_t> thinned_nodes(std::size_t count, int most);

/// A body per robot with its points among `nodes` (of RadioMeasurements::nodes, increasing); robots with a
/// known start are fixed there, the others are in their own start frame.
std::vector<RigidBody> fingerprint_bodies(const Mission& mission, const KnownStarts& starts,
                                          const RadioMeasurements& radio,
                                          const std::vector<std::size_t>& nodes);

}  // namespace radioslam

// What links say of an estimate that has not used them yet, or does not fit them.
#pragma once

#include <cstddef>

#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// The number of links between the two frames of the estimate's alignment by radio that have the most of
/// them; with `team` null, between two robots. `logged`: the mission as it is known.
template <class Pose>
std::size_t unjoined_links(const Mission& logged, const TeamEstimate<Pose>* team);

/// Whether the last links within frames have much less weight than all.
template <class Pose>
bool fits_worse_of_late(const TeamEstimate<Pose>& team);

}  // namespace radioslam

// Alignments that contradict the best one, and what it may still claim in face of them.
#pragma once

#include <vector>

#include "radioslam/joint/closures/loop_alignment.hpp"

namespace radioslam {

/// Whether two choices contradict each other: joins of either do not hold in the other.
template <class Pose>
bool contradict_each_other(const LoopAlignment<Pose>& a, const LoopAlignment<Pose>& b);

/// Parts the first alignment where less than a sighting and a half joins it, or where another puts the parts
/// together in another way with two thirds of the evidence that it contests.
template <class Pose>
void undo_weak_joins(const std::vector<LoopGroup>& groups, std::vector<LoopAlignment<Pose>>& alignments);

}  // namespace radioslam

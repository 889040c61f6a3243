// Stretches of a robot's trajectory whose evidence was mostly rejected.
//
// Every closure and link of a robot counts at its keyframe: the log likelihood ratio of its status where 95
// % are rejected to the share rejected over the whole mission, by kind. Kinds that are mostly rejected anyway
// (aliased matches, links round corners) say nothing about one stretch. The stretches are the disjoint
// intervals of largest sums, as in a scan statistic, of at least half a minute.
#pragma once

#include <utility>
#include <vector>

#include "radioslam/results/results.hpp"

namespace radioslam {

/// Per robot, in time order: first and last keyframe of each stretch.
std::vector<std::vector<std::pair<Stamp, Stamp>>> rejected_stretches(
    std::size_t robots, const std::vector<ClosureResult>& closures);

}  // namespace radioslam

// Poses from relative measurements alone, by composing them along a breadth-first tree of every component.
// Uses the fewest measurements per pose; no measurement is checked against another. Cost: linear.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Sets graph.poses. Fixed poses and the first pose of a component without one keep their values, as do
/// poses without relative measurements. Points and drifts are left as they are.
template <class Pose>
void initialise_from_spanning_tree(PoseGraph<Pose>& graph);

}  // namespace radioslam

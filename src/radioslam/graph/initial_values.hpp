// Initial values of an optimization: the candidate with the lowest cost.
#pragma once

#include <optional>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

// Poses from relative measurements alone, by composing them along a breadth-first tree of every component.
// Uses the fewest measurements per pose; no measurement is checked against another. Cost: linear.

/// Sets graph.poses. Fixed poses and the first pose of a component without one keep their values, as do
/// poses without relative measurements. Points and drifts are left as they are.
template <class Pose>
void initialise_from_spanning_tree(PoseGraph<Pose>& graph);

/// Whether the graph's poses are an estimate or placeholders.
enum class GivenValues { kComplete, kNone };

/// Which start was taken.
enum class InitialValues {
  kGiven,         ///< the graph's own poses
  kChordal,       ///< chordal initialisation from the relative poses
  kSpanningTree,  ///< relative poses composed along a breadth-first tree
};

/// The costs of the starts that were tried; nothing for one that was not to be had.
struct InitialCosts {
  InitialValues chosen = InitialValues::kGiven;
  std::optional<double> given, chordal, spanning_tree;
};

/// Sets graph.poses to the start with the lowest cost; at equal cost the given one, then the chordal one.
template <class Pose>
InitialCosts initialise(PoseGraph<Pose>& graph, GivenValues given);

}  // namespace radioslam

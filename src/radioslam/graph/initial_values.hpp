// Initial values of an optimisation: the candidate with the lowest cost.
#pragma once

#include <optional>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

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

// First pass over a g2o file: finds all poses and points, so that edges may precede their VERTEX lines.
// Reads the VERTEX lines whole, and only the ids of edges between poses, which may name poses without one.
// All tags are checked, so that a misspelt VERTEX line is not mistaken for a missing one.
#pragma once

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/g2o_vertices.hpp"

namespace radioslam {

/// Adds the poses and points with their ids to `out`. Poses that need a VERTEX line and have none are
/// included; refuse them with G2oVertices::refuse_missing after the second pass.
template <class Pose>
G2oVertices read_g2o_vertices(const Text& text, G2oGraph<Pose>& out);

}  // namespace radioslam

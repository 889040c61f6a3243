// First pass over a g2o file: finds all poses and points, so that edges may precede their VERTEX lines.
// Reads the VERTEX lines whole, and only the ids of edges between poses, which may name poses without one.
// All tags are checked, so that a misspelt VERTEX line is not mistaken for a missing one. Where bad lines are
// to be skipped, edges between poses are read whole here too, so that a corrupt one adds no pose.
#pragma once

#include <set>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/g2o_vertices.hpp"

namespace radioslam {

struct G2oVertexPass {
  G2oVertices vertices;
  std::set<std::size_t> bad_lines;  ///< numbers of the lines that the second pass must not read
};

/// Adds the poses and points with their ids to `out`, and the errors of bad lines that are to be skipped.
/// Poses that need a VERTEX line and have none are included unless bad lines are skipped; refuse them with
/// G2oVertices::refuse_missing after the second pass.
template <class Pose>
G2oVertexPass read_g2o_vertices(const Text& text, BadLines bad_lines, G2oGraph<Pose>& out);

}  // namespace radioslam

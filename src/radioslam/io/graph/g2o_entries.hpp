// Reads the parts that several kinds of lines of a g2o file have in common: poses and the two ids of an edge.
#pragma once

#include <cstdint>
#include <string>

#include "radioslam/io/graph/g2o_vertices.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {

/// x y theta, or x y z qx qy qz qw.
template <class Pose>
Pose read_g2o_pose(LineFields& fields) {
  if constexpr (Pose::kDim == 2) {
    const double x = fields.coordinate("x");
    const double y = fields.coordinate("y");
    return {{x, y}, fields.number("theta")};
  } else {
    return fields.pose();
  }
}

struct G2oEdgeIds {
  G2oVertices::Id i = 0;
  G2oVertices::Id j = 0;
};

/// Refuses an edge from a vertex to itself.
inline G2oEdgeIds read_g2o_edge_ids(LineFields& fields) {
  const G2oVertices::Id i = fields.id("id");
  const G2oVertices::Id j = fields.id("id");
  if (i == j) fields.fail("an edge from " + quoted_vertex(i) + " to itself");
  return {i, j};
}

}  // namespace radioslam

// Reads the parts that several kinds of lines of a g2o file have in common: poses and the two ids of an edge.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/graph/g2o_vertices.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {

/// Tags at the beginning of the lines of a g2o file.
template <class Pose>
struct G2oTags;

template <>
struct G2oTags<SE2> {
  static constexpr std::string_view kVertex = "VERTEX_SE2";
  static constexpr std::string_view kPoint = "VERTEX_XY";
  static constexpr std::string_view kEdge = "EDGE_SE2";
  static constexpr std::string_view kPrior = "EDGE_PRIOR_SE2";
  static constexpr std::string_view kOffset = "PARAMS_SE2OFFSET";
  static constexpr std::string_view kSighting = "EDGE_SE2_XY";
  static constexpr std::string_view kUnsupported = "EDGE_BEARING_SE2_XY";
};

template <>
struct G2oTags<SE3> {
  static constexpr std::string_view kVertex = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kPoint = "VERTEX_TRACKXYZ";
  static constexpr std::string_view kEdge = "EDGE_SE3:QUAT";
  static constexpr std::string_view kPrior = "EDGE_SE3_PRIOR";
  static constexpr std::string_view kOffset = "PARAMS_SE3OFFSET";
  static constexpr std::string_view kSighting = "EDGE_SE3_TRACKXYZ";
  static constexpr std::string_view kUnsupported = "EDGE_SE3_XYZ";
};

inline constexpr std::string_view kG2oRange = "EDGE_RANGE";
inline constexpr std::string_view kG2oFix = "FIX";

/// Whether `tag` belongs to graphs of this dimension.
template <class Pose>
constexpr bool is_g2o_tag(std::string_view tag) {
  using Tags = G2oTags<Pose>;
  return tag == Tags::kVertex || tag == Tags::kPoint || tag == Tags::kEdge || tag == Tags::kPrior ||
         tag == Tags::kOffset || tag == Tags::kSighting || tag == Tags::kUnsupported;
}

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

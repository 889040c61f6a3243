#include "radioslam/io/graph/g2o_vertex_pass.hpp"

#include "radioslam/io/graph/field_matrices.hpp"
#include "radioslam/io/graph/g2o_entries.hpp"
#include "radioslam/io/graph/g2o_tags.hpp"

namespace radioslam {
namespace {

template <class Pose>
void read_pose_vertex(const TextLines& lines, LineFields& fields, G2oVertices& vertices,
                      G2oGraph<Pose>& out) {
  const G2oVertices::Id id = fields.id("id");
  vertices.declare(id, {false, static_cast<std::int32_t>(out.graph.poses.size())}, lines.number());
  out.graph.poses.push_back(read_g2o_pose<Pose>(fields));
  out.pose_ids.push_back(id);
  out.pose_has_value.push_back(true);
  fields.end();
}

template <class Pose>
void read_point_vertex(const TextLines& lines, LineFields& fields, G2oVertices& vertices,
                       G2oGraph<Pose>& out) {
  const G2oVertices::Id id = fields.id("id");
  vertices.declare(id, {true, static_cast<std::int32_t>(out.graph.points.size())}, lines.number());
  out.graph.points.push_back(read_point_fields<Pose>(fields));
  out.point_ids.push_back(id);
  fields.end();
}

/// Refuses tags other than those of lines that can be read.
template <class Pose>
void check_tag(const TextLines& lines, std::string_view tag) {
  using OtherPose = std::conditional_t<Pose::kDim == 2, SE3, SE2>;
  if (tag == kG2oRange || tag == kG2oFix) return;
  if (is_g2o_tag<Pose>(tag) && tag != G2oTags<Pose>::kUnsupported) return;
  const std::string name(tag.substr(0, 40));
  if (is_g2o_tag<OtherPose>(tag)) lines.fail(name + ": the graph mixes 2D and 3D");
  if (is_g2o_tag<Pose>(tag)) lines.fail(name + ": such landmark edges are not supported");
  lines.fail("unknown tag '" + name + "'");
}

void mention_ends(const TextLines& lines, LineFields& fields, G2oVertices& vertices) {
  const G2oEdgeIds ids = read_g2o_edge_ids(fields);
  for (const G2oVertices::Id id : {ids.i, ids.j}) vertices.mention(id, lines.number());
}

template <class Pose>
void add_undeclared_poses(G2oVertices& vertices, G2oGraph<Pose>& out) {
  for (const G2oVertices::Id id : vertices.add_undeclared(out.graph.poses.size())) {
    out.graph.poses.emplace_back();
    out.pose_ids.push_back(id);
    out.pose_has_value.push_back(false);
  }
}

}  // namespace

template <class Pose>
G2oVertices read_g2o_vertices(const Text& text, G2oGraph<Pose>& out) {
  using Tags = G2oTags<Pose>;
  G2oVertices vertices(text);
  TextLines lines(text);
  while (lines.next_with_content()) {
    LineFields fields(lines);
    const std::string_view tag = fields.next("a tag");
    check_tag<Pose>(lines, tag);
    if (tag == Tags::kEdge) mention_ends(lines, fields, vertices);
    if (tag == Tags::kVertex) read_pose_vertex(lines, fields, vertices, out);
    if (tag == Tags::kPoint) read_point_vertex(lines, fields, vertices, out);
  }
  add_undeclared_poses(vertices, out);
  return vertices;
}

template G2oVertices read_g2o_vertices(const Text&, G2oGraph<SE2>&);
template G2oVertices read_g2o_vertices(const Text&, G2oGraph<SE3>&);

}  // namespace radioslam

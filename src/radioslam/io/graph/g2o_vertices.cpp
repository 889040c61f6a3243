#include "radioslam/io/graph/g2o_vertices.hpp"

#include <algorithm>

#include "radioslam/io/graph/g2o_entries.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {
namespace {

/// Bound on the relative difference of two printed copies of a value.
constexpr double kRounding = 2e-5;

G2oVertices::Id robot_of(G2oVertices::Id id) { return id >> kKeyRobotShift; }

template <class Pose>
void read_pose_vertex(const TextLines& lines, LineFields& fields, G2oVertices& vertices,
                      G2oGraph<Pose>& out) {
  const G2oVertices::Id id = fields.id("id");
  const Pose pose = read_g2o_pose<Pose>(fields);
  fields.end();
  const auto is_same = [&](G2oVertex earlier) {
    if (earlier.is_point) return false;
    const Pose& before = out.graph.poses[static_cast<std::size_t>(earlier.index)];
    return (before.inverse() * pose).log().norm() < kRounding * std::max(1.0, pose.translation().norm());
  };
  vertices.declare(id, {false, static_cast<std::int32_t>(out.graph.poses.size())}, lines.number(), is_same);
  out.graph.poses.push_back(pose);
  out.pose_ids.push_back(id);
  out.pose_has_value.push_back(true);
}

template <class Pose>
void read_point_vertex(const TextLines& lines, LineFields& fields, G2oVertices& vertices,
                       G2oGraph<Pose>& out) {
  const G2oVertices::Id id = fields.id("id");
  const typename Pose::Point point = read_point_fields<Pose>(fields);
  fields.end();
  const auto is_same = [&](G2oVertex earlier) {
    return earlier.is_point && (out.graph.points[static_cast<std::size_t>(earlier.index)] - point).norm() <
                                   kRounding * std::max(1.0, point.norm());
  };
  vertices.declare(id, {true, static_cast<std::int32_t>(out.graph.points.size())}, lines.number(), is_same);
  out.graph.points.push_back(point);
  out.point_ids.push_back(id);
}

template <class Pose>
void refuse_other_dimension(const TextLines& lines, std::string_view tag) {
  using OtherPose = std::conditional_t<Pose::kDim == 2, SE3, SE2>;
  if (is_g2o_tag<OtherPose>(tag)) lines.fail(std::string(tag) + ": the graph mixes 2D and 3D");
}

/// Refuses tags other than those of lines that can be read.
template <class Pose>
void check_tag(const TextLines& lines, std::string_view tag) {
  if (tag == kG2oRange || tag == kG2oFix) return;
  if (is_g2o_tag<Pose>(tag) && tag != G2oTags<Pose>::kUnsupported) return;
  const std::string name(tag.substr(0, 40));
  if (is_g2o_tag<Pose>(tag)) lines.fail(name + ": such landmark edges are not supported");
  lines.fail("unknown tag '" + name + "'");
}

template <class Pose>
void mention_ends(const TextLines& lines, LineFields& fields, BadLines bad_lines, G2oVertices& vertices) {
  const G2oEdgeIds ids = read_g2o_edge_ids(fields);
  if (bad_lines == BadLines::kSkip) {
    read_g2o_pose<Pose>(fields);
    read_upper_triangle<Pose::kDof>(fields, "information");
    fields.end();
  }
  for (const G2oVertices::Id id : {ids.i, ids.j}) vertices.mention(id, lines.number());
}

template <class Pose>
void add_undeclared_poses(BadLines bad_lines, const IsElsewhere& is_elsewhere, G2oVertices& vertices,
                          G2oGraph<Pose>& out) {
  for (const G2oVertices::Id id : vertices.add_undeclared(out.graph.poses.size(), bad_lines, is_elsewhere)) {
    out.graph.poses.emplace_back();
    out.pose_ids.push_back(id);
    out.pose_has_value.push_back(false);
  }
}

template <class Pose>
void read_line(const TextLines& lines, std::string_view tag, LineFields& fields, BadLines bad_lines,
               G2oVertices& vertices, G2oGraph<Pose>& out) {
  using Tags = G2oTags<Pose>;
  check_tag<Pose>(lines, tag);
  if (tag == Tags::kEdge) mention_ends<Pose>(lines, fields, bad_lines, vertices);
  if (tag == Tags::kVertex) read_pose_vertex(lines, fields, vertices, out);
  if (tag == Tags::kPoint) read_point_vertex(lines, fields, vertices, out);
}

}  // namespace

std::string quoted_vertex(G2oVertices::Id id) { return "vertex " + std::to_string(id); }

void G2oVertices::declare(Id id, G2oVertex vertex, std::size_t line,
                          const std::function<bool(G2oVertex)>& is_same) {
  const auto [earlier, is_new] = vertices_.emplace(id, vertex);
  if (!is_new && !contradiction_ && !is_same(earlier->second)) contradiction_ = Mention{id, line};
  if (!is_new) text_.fail(line, quoted_vertex(id) + " appears twice");
  if (!vertex.is_point) robots_.insert(robot_of(id));
}

void G2oVertices::refuse_contradictions() const {
  if (!contradiction_) return;
  std::string reason = quoted_vertex(contradiction_->id) + " appears twice, with different values";
  if (robot_of(contradiction_->id) == 0)
    reason +=
        "; if these are poses of two robots, the robots' letters are missing in the ids (top eight bits)";
  text_.fail(contradiction_->line, reason);
}

std::optional<std::size_t> G2oVertices::line_of_cut_ids() const {
  if (robots_.contains(0) || std::none_of(robots_.begin(), robots_.end(), is_key_letter)) return std::nullopt;
  std::set<std::size_t> lines;
  for (const Mention& mention : mentions_)
    if (robot_of(mention.id) == 0 && !vertices_.contains(mention.id)) lines.insert(mention.line);
  return lines.size() == 1 ? std::optional(*lines.begin()) : std::nullopt;
}

std::vector<G2oVertices::Id> G2oVertices::add_undeclared(std::size_t first_index, BadLines bad_lines,
                                                         const IsElsewhere& is_elsewhere) {
  const auto cut = bad_lines == BadLines::kSkip ? line_of_cut_ids() : std::nullopt;
  std::vector<Id> undeclared;
  for (const Mention& mention : mentions_) {
    if (vertices_.contains(mention.id) || mention.line == cut) continue;
    const bool is_missing =
        robots_.contains(robot_of(mention.id)) && !(is_elsewhere && is_elsewhere(mention.id));
    if (is_missing && bad_lines == BadLines::kSkip) continue;
    if (is_missing && !missing_) missing_ = mention;
    undeclared.push_back(mention.id);
  }
  std::sort(undeclared.begin(), undeclared.end());
  undeclared.erase(std::unique(undeclared.begin(), undeclared.end()), undeclared.end());
  for (const Id id : undeclared)
    vertices_.emplace(id, G2oVertex{false, static_cast<std::int32_t>(first_index++)});
  return undeclared;
}

void G2oVertices::refuse_missing() const {
  if (missing_)
    text_.fail(missing_->line, quoted_vertex(missing_->id) +
                                   " has no VERTEX line, although other poses of its robot have one");
}

G2oVertex G2oVertices::at(Id id, std::size_t line) const {
  const auto found = vertices_.find(id);
  if (found == vertices_.end())
    text_.fail(line, quoted_vertex(id) + " does not occur in a VERTEX line or in an edge between poses");
  return found->second;
}

PoseId G2oVertices::pose_at(Id id, std::size_t line) const {
  const G2oVertex vertex = at(id, line);
  if (vertex.is_point) text_.fail(line, quoted_vertex(id) + " is a point, not a pose");
  return PoseId(vertex.index);
}

template <class Pose>
G2oVertexPass read_g2o_vertices(const Text& text, BadLines bad_lines, const IsElsewhere& is_elsewhere,
                                G2oGraph<Pose>& out) {
  G2oVertexPass pass{G2oVertices(text), {}};
  TextLines lines(text);
  while (lines.next_with_content()) {
    LineFields fields(lines);
    const std::string_view tag = fields.next("a tag");
    refuse_other_dimension<Pose>(lines, tag);
    try {
      read_line(lines, tag, fields, bad_lines, pass.vertices, out);
    } catch (const InputError& error) {
      pass.vertices.refuse_contradictions();
      if (bad_lines == BadLines::kRefuse) throw;
      out.skipped_lines.add(error);
      pass.bad_lines.insert(lines.number());
    }
  }
  add_undeclared_poses(bad_lines, is_elsewhere, pass.vertices, out);
  return pass;
}

template G2oVertexPass read_g2o_vertices(const Text&, BadLines, const IsElsewhere&, G2oGraph<SE2>&);
template G2oVertexPass read_g2o_vertices(const Text&, BadLines, const IsElsewhere&, G2oGraph<SE3>&);

}  // namespace radioslam

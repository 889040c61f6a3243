#include "radioslam/io/graph/g2o_vertices.hpp"

#include <algorithm>

#include "radioslam/io/graph/graph_keys.hpp"

namespace radioslam {
namespace {

G2oVertices::Id robot_of(G2oVertices::Id id) { return id >> kKeyRobotShift; }

}  // namespace

std::string quoted_vertex(G2oVertices::Id id) { return "vertex " + std::to_string(id); }

void G2oVertices::declare(Id id, G2oVertex vertex, std::size_t line) {
  if (!vertices_.emplace(id, vertex).second) text_.fail(line, quoted_vertex(id) + " appears twice");
  if (!vertex.is_point) robots_.insert(robot_of(id));
}

std::vector<G2oVertices::Id> G2oVertices::add_undeclared(std::size_t first_index, BadLines bad_lines) {
  std::vector<Id> undeclared;
  for (const Mention& mention : mentions_) {
    if (vertices_.contains(mention.id)) continue;
    const bool is_missing = robots_.contains(robot_of(mention.id));
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

}  // namespace radioslam

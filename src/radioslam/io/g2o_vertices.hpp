// What the ids of a g2o file stand for, and which poses may go without a VERTEX line.
// A file without VERTEX lines names its poses in its edges. A file of one robot of a team names the others'
// poses in edges only; a robot's letter fills the top eight bits of its ids (GTSAM's symbols). But a robot
// that has VERTEX lines of poses has one for each of them: an edge that names another is torn or slipped.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// A pose or a point, by its place in the graph.
struct G2oVertex {
  bool is_point = false;
  std::int32_t index = 0;
};

/// The vertices of one file. Refusals name the line that is asked for.
class G2oVertices {
 public:
  using Id = std::uint64_t;

  explicit G2oVertices(const Text& text) : text_(text) {}

  /// An id's VERTEX line; refused the second time.
  void declare(Id id, G2oVertex vertex, std::size_t line);
  /// An edge between poses names this id; refused at the end of the file unless it may go undeclared.
  void mention(Id id, std::size_t line) { mentions_.push_back({id, line}); }
  /// The ids that are only mentioned, sorted, each once; they become poses from `first_index` on.
  std::vector<Id> add_undeclared(std::size_t first_index);

  /// Refuse an id that stands for nothing.
  G2oVertex at(Id id, std::size_t line) const;
  PoseId pose_at(Id id, std::size_t line) const;

 private:
  struct Mention {
    Id id;
    std::size_t line;
  };

  const Text& text_;
  std::unordered_map<Id, G2oVertex> vertices_;  // looked up, never walked through
  std::set<Id> robots_;                         // with VERTEX lines of poses
  std::vector<Mention> mentions_;
};

/// "vertex 7", for messages.
std::string quoted_vertex(G2oVertices::Id id);

}  // namespace radioslam

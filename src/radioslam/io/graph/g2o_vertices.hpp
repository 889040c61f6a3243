// Maps the ids of a g2o file to poses and points, and checks which poses need a VERTEX line.
// In a file without VERTEX lines, poses are defined by the edges. In the file of one robot of a team, the
// poses of other robots appear in edges only; a robot's letter is in the top eight bits of its ids (GTSAM
// symbols). But if a robot has VERTEX lines of poses, all its poses must have one: otherwise the edge is
// considered corrupt.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// A pose or a point, by its index in the graph.
struct G2oVertex {
  bool is_point = false;
  std::int32_t index = 0;
};

/// The vertices of one file. Errors name the given line.
class G2oVertices {
 public:
  using Id = std::uint64_t;

  explicit G2oVertices(const Text& text) : text_(text) {}

  /// Adds the VERTEX line of an id; refuses a second one. `is_same(earlier)`: it has the value of the earlier
  /// vertex.
  void declare(Id id, G2oVertex vertex, std::size_t line, const std::function<bool(G2oVertex)>& is_same);
  /// Records that an edge between poses names this id.
  void mention(Id id, std::size_t line) { mentions_.push_back({id, line}); }
  /// Adds the poses that appear in edges only, from `first_index` on; returns their ids, sorted and unique.
  /// Where bad lines are skipped, those of robots with VERTEX lines are not added, unless they are elsewhere:
  /// their edges are bad lines.
  std::vector<Id> add_undeclared(std::size_t first_index, BadLines bad_lines,
                                 const IsElsewhere& is_elsewhere);
  /// Refuses an id that has two different values, also where bad lines are skipped.
  void refuse_contradictions() const;
  /// Refuses the first of them whose robot has VERTEX lines of other poses.
  void refuse_missing() const;

  /// The vertex of an id; refuses unknown ids.
  G2oVertex at(Id id, std::size_t line) const;
  PoseId pose_at(Id id, std::size_t line) const;

 private:
  struct Mention {
    Id id;
    std::size_t line;
  };

  /// The line of the only edge with ids without letters, where robots with letters have the VERTEX lines: its
  /// ids are cut off.
  std::optional<std::size_t> line_of_cut_ids() const;

  const Text& text_;
  std::unordered_map<Id, G2oVertex> vertices_;  // used for look-up only, never iterated
  std::set<Id> robots_;                         // robots with VERTEX lines of poses
  std::vector<Mention> mentions_;
  std::optional<Mention> missing_;
  std::optional<Mention> contradiction_;  // the VERTEX line with the second value
};

/// "vertex 7", for messages.
std::string quoted_vertex(G2oVertices::Id id);

/// First pass over a g2o file: finds all poses and points, so that edges may precede their VERTEX lines.
/// Reads the VERTEX lines whole, and only the ids of edges between poses, which may name poses without one.
/// All tags are checked, so that a misspelt VERTEX line is not mistaken for a missing one. Where bad lines
/// are to be skipped, edges between poses are read whole here too, so that a corrupt one adds no pose.
struct G2oVertexPass {
  G2oVertices vertices;
  std::set<std::size_t> bad_lines;  ///< numbers of the lines that the second pass must not read
};

/// Adds the poses and points with their ids to `out`, and the errors of bad lines that are to be skipped.
/// Poses that need a VERTEX line and have none are included unless bad lines are skipped; refuse them with
/// G2oVertices::refuse_missing after the second pass.
template <class Pose>
G2oVertexPass read_g2o_vertices(const Text& text, BadLines bad_lines, const IsElsewhere& is_elsewhere,
                                G2oGraph<Pose>& out);

}  // namespace radioslam

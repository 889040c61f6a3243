// First pass over a PyFG file: reads the VERTEX lines, so that factors may precede them, and finds the pose
// or point of a name.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {

/// The vertices of one file, poses and points each in the order of their lines.
template <class Pose>
struct PyfgVertices {
  std::vector<PoseIndex> places;  ///< robot, index and stamp of each pose
  std::vector<std::string> pose_names;
  std::vector<std::size_t> pose_lines;
  std::vector<Pose> true_poses;
  std::vector<std::string> point_names;
  std::vector<typename Pose::Point> true_points;
  std::unordered_map<std::string, RangeEnd<Pose>> by_name;  ///< used for look-up only, never iterated

  /// The pose or point with this name; `at` is the line that names it. Refuses unknown names.
  RangeEnd<Pose> find(const TextLines& at, std::string_view name) const;
  /// Also refuses points.
  PoseId find_pose(const TextLines& at, std::string_view name) const;
};

/// Refuses malformed lines, implausible times, ids that are not letters and a number, and repeated names.
template <class Pose>
PyfgVertices<Pose> read_pyfg_vertices(const Text& text);

/// x y theta, or x y z qx qy qz qw.
template <class Pose>
Pose read_pyfg_pose(LineFields& fields);

/// The beginning of a word of the file, for error messages.
std::string quoted_pyfg_word(std::string_view word);

}  // namespace radioslam

// Reads a team's factor graph from a PyFG, JRL or g2o file, optionally compressed with Zstandard, or from a
// folder of g2o files, one per robot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/graph/team_graph.hpp"
#include "radioslam/io/graph/g2o.hpp"

namespace radioslam {

/// Whether the graph has any factor; poses of a graph without are measured by nothing.
template <class Pose>
bool measures_anything(const PoseGraph<Pose>& graph) {
  return !(graph.relative_poses.empty() && graph.ranges.empty() && graph.bearings.empty() &&
           graph.relative_points.empty() && graph.positions.empty() && graph.pose_priors.empty());
}

/// What becomes of the robots' starts that a file states: priors on poses, and in g2o the VERTEX lines of the
/// robots' first poses.
enum class StatedStarts {
  kIgnored,  ///< they do not place robots: priors on several robots are left out, with a note
  kPriors,   ///< those of priors are used, VERTEX lines are not
  kUsed,     ///< the robots that have one are in the common frame
};

/// The team in a file. The values of the graph do not come from the file's VERTEX lines: each segment is dead
/// reckoning from the identity, or from its first prior if this is used; points are at the origin or at their
/// first prior. Priors on one robot alone are used in any case: they only choose the frame.
template <class Pose>
struct TeamGraphFile {
  TeamGraph<Pose> team;
  std::vector<std::string> pose_names;   ///< per pose, as in the file
  std::vector<std::string> point_names;  ///< per point
  std::vector<std::uint64_t> pose_ids;   ///< per pose, its key (team_assembly.hpp); empty if they have none
  std::vector<std::uint64_t> point_ids;  ///< the same per point
  /// Per pose, in the common frame; nothing where unknown. Empty if unknown for all.
  std::vector<std::optional<Pose>> true_poses;
  /// Per relative pose of the graph, whether it is true; nothing where unknown. Empty if unknown for all.
  std::vector<std::optional<bool>> labels;
  std::vector<std::string> notes;                 ///< for the user, on what was left out
  std::vector<typename Pose::Point> true_points;  ///< per point, in the common frame; empty if unknown
};

using AnyTeamGraphFile = std::variant<TeamGraphFile<SE2>, TeamGraphFile<SE3>>;

/// Whether the path is that of a graph file: it ends in .g2o, .pyfg or .jrl, and perhaps .zst after it.
bool is_graph_file(const std::filesystem::path& path);

/// Whether the path is a folder of g2o files and not a mission.
bool is_graph_folder(const std::filesystem::path& path);

/// Reads a file in the format given by its extension, or all g2o files of a folder. Errors are InputErrors
/// with file and line. Refuses a graph of several poses between which nothing is measured.
AnyTeamGraphFile read_team_graph(const std::filesystem::path& path,
                                 StatedStarts starts = StatedStarts::kIgnored,
                                 RepairInformation repair = RepairInformation::kNo);
/// Reads a team from several g2o files, at least one, or from one path as above.
AnyTeamGraphFile read_team_graph(const std::vector<std::filesystem::path>& paths, StatedStarts starts,
                                 RepairInformation repair = RepairInformation::kNo);

}  // namespace radioslam

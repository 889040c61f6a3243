// Reads a team's factor graph from a PyFG or g2o file, optionally compressed with Zstandard, or from a folder
// of g2o files, one per robot.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// The team in a file. The values of the graph do not come from the file's VERTEX lines: each segment is dead
/// reckoning from the identity or from its first prior; points are at the origin or at their first prior.
template <class Pose>
struct TeamGraphFile {
  TeamGraph<Pose> team;
  std::vector<std::string> pose_names;            ///< per pose, as in the file
  std::vector<std::string> point_names;           ///< per point
  std::vector<Pose> true_poses;                   ///< per pose, in the common frame; empty if unknown
  std::vector<typename Pose::Point> true_points;  ///< per point, in the common frame; empty if unknown
};

using AnyTeamGraphFile = std::variant<TeamGraphFile<SE2>, TeamGraphFile<SE3>>;

/// Whether the path is that of a graph file: it ends in .g2o or .pyfg, optionally followed by .zst.
bool is_graph_file(const std::filesystem::path& path);

/// Reads a file in the format given by its extension, or all g2o files of a folder. Errors are InputErrors
/// with file and line.
AnyTeamGraphFile read_team_graph(const std::filesystem::path& path);

}  // namespace radioslam

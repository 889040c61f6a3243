// A team's factor graph from a file: PyFG or g2o, either compressed with Zstandard, or a folder of g2o files,
// one per robot.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// The team as its file gives it. No value of the graph comes from the file's VERTEX lines: each piece is
/// dead reckoning from the identity (from its first prior, if it has one), points are at the origin (at their
/// first prior).
template <class Pose>
struct TeamGraphFile {
  TeamGraph<Pose> team;
  std::vector<std::string> pose_names;            ///< per pose, as in the file
  std::vector<std::string> point_names;           ///< per point
  std::vector<Pose> true_poses;                   ///< per pose, in the common frame; empty: not known
  std::vector<typename Pose::Point> true_points;  ///< per point; likewise
};

using AnyTeamGraphFile = std::variant<TeamGraphFile<SE2>, TeamGraphFile<SE3>>;

/// Is this a path that read_team_graph takes for a graph: does it end in .g2o or .pyfg, before any .zst?
bool is_graph_file(const std::filesystem::path& path);

/// Reads the file by what its name ends in, or all of a folder's g2o files. Refusals are InputErrors with
/// file and line.
AnyTeamGraphFile read_team_graph(const std::filesystem::path& path);

}  // namespace radioslam

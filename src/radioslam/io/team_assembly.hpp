// From a file's factors to a team: which poses form a piece, and where each stands in it.
//
// Poses are ordered by robot (in the order of first mention) and place. An edge from a pose to the robot's
// next one is its odometry; of several the first one, the others close loops. Where it is missing, a new
// piece begins. Cost: a sort of the poses, linear in the rest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// Which robot a pose belongs to, and where in its chain. No two poses share both.
struct PosePlace {
  std::string robot;
  std::uint64_t place = 0;
  std::optional<Stamp> stamp;  ///< absent: the place counts as seconds
};

template <class Pose>
struct AssembledTeam {
  TeamGraph<Pose> team;
  std::vector<std::size_t> file_index;  ///< per pose of the team, its index in the file's graph
};

/// `graph` has the file's factors, and poses and points without values; `places` is per pose. Odometry comes
/// first among the relative poses, in the order of the poses; the others follow as in the file. A pose at the
/// stamp of the one before it counts as one nanosecond later. Stamps must not run backwards within a robot
/// (first_backward_stamp).
template <class Pose>
AssembledTeam<Pose> assemble_team(PoseGraph<Pose> graph, const std::vector<PosePlace>& places);

/// A pose whose stamp lies before that of its robot's previous place, as an index of `places`.
std::optional<std::size_t> first_backward_stamp(const std::vector<PosePlace>& places);

}  // namespace radioslam

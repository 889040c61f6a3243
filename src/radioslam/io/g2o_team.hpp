// A team's pose graph in g2o's format (g2o.hpp), in one file or in one file per robot.
//
// The top eight bits of an id are its robot's letter (GTSAM's symbols), the rest is the place in its chain;
// ids without a letter are those of one robot, `a`. Edges between robots stay relative poses. VERTEX values
// are some solver's start: neither truth nor used as a start here. FIX lines are passed over, as an aligner
// chooses its own frame. A robot's stamps are its places, in seconds.
#pragma once

#include <span>

#include "radioslam/io/team_graph_file.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// Reads the files of a team, at least one. Edges between robots stand in the files of both, and count once
/// if they are equal up to the rounding of printed numbers. Refusals are those of read_g2o, and files of
/// different dimensions.
AnyTeamGraphFile read_g2o_team(std::span<const Text> texts);

}  // namespace radioslam

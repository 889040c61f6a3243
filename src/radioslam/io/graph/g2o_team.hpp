// Reads a team's pose graph in g2o's format (g2o.hpp), from one file or from one file per robot.
//
// The top eight bits of an id are its robot's letter (GTSAM symbols), the rest is the index along its
// trajectory; ids without a letter belong to a single robot, `a`, or in several files to a robot per file,
// named after it (team_ids.hpp). Edges between robots remain relative poses.
// VERTEX values are an initial estimate of unknown origin; they are not used as ground truth, and as starts
// only on request: those of the robots' first poses, where a robot has no prior. FIX lines are ignored,
// because the alignment chooses its own frame. A pose's stamp is its index in seconds.
#pragma once

#include <span>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Reads the files of a team, at least one. Edges between robots may appear in the files of both; they count
/// once if they are equal up to the rounding of printed numbers. Lines that cannot be read are left out, with
/// a note. Refuses whatever read_g2o then refuses, files of different dimensions, files of one name without
/// letters, and teams with and without letters.
AnyTeamGraphFile read_g2o_team(std::span<const Text> texts, StatedStarts starts = StatedStarts::kIgnored,
                               RepairInformation repair = RepairInformation::kNo);

}  // namespace radioslam

// radioslam optimize --distributed: optimizes the pose graph of a team as its robots would, each with its own
// part and messages between neighbours, and compares with the central optimum.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "radioslam/cli/commands/optimize_params.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"

namespace radioslam::cli {

struct DistributedOutcome {
  nlohmann::ordered_json json;  ///< what --json prints
  std::string summary;          ///< the same in two sentences, and a line per note
  std::string graph;            ///< g2o text of all robots, with the vertices as the robots have them
};

/// The names of the methods for which a member of DistributedMethodInfo is true, for messages and help.
std::string methods_that_bear(bool DistributedMethodInfo::*what);

/// One graph of a team or one per robot. Refuses (InputError) other factors than relative poses.
AnyTeamGraphFile read_distributed_team(const std::vector<std::filesystem::path>& paths);

/// `paths`: one graph of a team or one per robot. `method`: its name in kDistributedMethods. Refuses a
/// network that the method does not bear.
DistributedOutcome optimize_distributed(const std::vector<std::filesystem::path>& paths,
                                        const std::string& method, const OptimizeParams& params);

}  // namespace radioslam::cli

// Optimization without a centre (`optimize --distributed`) by every method: relative gap to the central
// optimum over rounds and over bytes sent.
//
// Teams are simulated, or those of given graphs. Cost: 15 s for the simulated ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/distributed/team_outcome.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

inline constexpr int kStudyRounds = 600;  ///< that a method may take

struct DistributedRun {
  std::string method;
  bool settled = false;  ///< the robots stopped by themselves
  TeamOutcome outcome;
  std::vector<std::size_t> bytes;  ///< sent up to the end of each round, by all robots
};

/// A team's runs, one per method.
struct DistributedTeam {
  std::string name;
  std::size_t robots = 0, poses = 0, factors = 0, factors_between = 0, bytes_of_all_graphs = 0;
  std::vector<DistributedRun> runs;
};

/// `team`: relative poses only, as for optimize_team.
template <class Pose>
DistributedTeam study_distributed_team(const std::string& name, const TeamGraph<Pose>& team,
                                       const Progress& progress = {});

/// Two and ten robots that drive laps, four and nine in blocks.
std::vector<DistributedTeam> study_simulated_teams(std::uint64_t seed, const Progress& progress = {});

StudyTable distributed_table(const std::vector<DistributedTeam>& teams);

}  // namespace radioslam

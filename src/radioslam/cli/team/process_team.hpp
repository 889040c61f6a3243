// A team of agents, each a process of its own (radioslam agent), on one machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/live/live_address.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {

struct ProcessTeamSetup {
  std::string mission;
  std::vector<std::string> robots;
  int dimension = 2;  ///< of the mission
  Stamp begin;        ///< of the mission
  double rate = 10;
  std::optional<std::uint32_t> domain;  ///< else one that no other team of this machine has
  std::vector<std::string> options;     ///< more, for every agent
  /// Where the first agent's page is, with those of the others at the ports behind, and the pages' token.
  std::optional<LiveAddress> live = {};
  std::string live_token = {};
};

struct ProcessTeamRun {
  TeamRun run;                      ///< of the agents that came to their end
  std::vector<std::string> failed;  ///< in words, a line each
};

/// Starts the agents, which write their results to `folder`/agents/ID, and waits for their ends. Their
/// journals are kept in `folder`/journals until then. Asked to conclude (ending.hpp), asks them to.
ProcessTeamRun run_processes(const ProcessTeamSetup& setup, const std::filesystem::path& folder);

}  // namespace radioslam::cli

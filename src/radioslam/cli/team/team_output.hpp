// What the agents of a team are written as: each one's result, the team's, and what they knew and sent.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/cli/run_documents.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {

std::string traffic_csv(const TeamTraffic& traffic);
/// Times are since `begin`.
std::string agents_csv(const std::vector<KnownThen>& known, Stamp begin);
/// How many records of whom this agent had.
std::string known_csv(const std::vector<KnownThen>& known, const std::string& agent, Stamp begin);
std::string events_csv(const std::vector<std::pair<std::string, TeamEvent>>& events, Stamp begin);

/// Position error (RMSE) of these robots; nothing without a truth.
std::optional<double> team_error_m(const std::vector<EstimatedTrajectory>& team, const Truth& truth,
                                   int dimension);

/// Writes traffic.csv, agents.csv and events.csv, and reads them again, of one agent or of several.
void write_tables(const std::filesystem::path& folder, const TeamRun& run, Stamp begin);
void read_tables(const std::filesystem::path& folder, Stamp begin, TeamRun& run);

/// Whether each agent's result is written to agents/ID, or has been.
enum class AgentFolders { kWritten, kThere };

/// The estimate of each agent from the logs that it has in the end, said in a line, and in the folder itself
/// that of all records together. Throws InputError where no robot has said anything.
void write_results(const TeamRun& run, const RunParams& params, const MissionInput& given,
                   const std::filesystem::path& folder, AgentFolders agents, Stamp begin);
/// That of one agent alone.
void write_agent(const TeamRun& run, const std::string& agent, const RunParams& params,
                 const MissionInput& given, const std::filesystem::path& folder, Stamp begin);

}  // namespace radioslam::cli

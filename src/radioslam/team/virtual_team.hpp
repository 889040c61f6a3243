// A team of agents in one process and in virtual time, over a network with faults: the same for the same
// seed.
//
// A robot that is killed keeps what its store has and loses all else; where it is started again, that is with
// a new front end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/live/team_stream.hpp"
#include "radioslam/team/agent.hpp"
#include "radioslam/team/scripted_robots.hpp"
#include "radioslam/team/virtual_network.hpp"

namespace radioslam {

/// What outlives an agent.
class AgentStore {
 public:
  virtual ~AgentStore() = default;
  virtual AgentMemory memory() const = 0;
  virtual void commit(const JournalChange& change) = 0;
  /// As last committed under this key, without reading the rest.
  virtual std::optional<std::string> state(const std::string& key) const = 0;
};
std::unique_ptr<AgentStore> store_in_memory(const std::string& robot, std::uint32_t life);
/// Of a robot that is not started again: it keeps nothing.
std::unique_ptr<AgentStore> store_of_nothing(std::uint32_t life);

/// An agent's state at a time.
struct KnownThen {
  Stamp at;
  std::string agent;
  double share = 0;                 ///< of the records that all robots have said
  std::size_t robots_in_frame = 0;  ///< of the largest frame it knows; 0: it has no estimate
  std::optional<double> error_m{};  ///< of that frame, where the truth is known
  std::map<std::string, std::uint64_t> records = {};  ///< that it has, by robot, without a gap
};

/// What an agent sent, received and refused in all.
struct AgentCounts {
  std::size_t bytes_sent = 0, bytes_received = 0;
  std::map<std::string, std::map<std::string, std::size_t>> refused = {};  ///< by peer and reason
};

struct TeamRun {
  TeamTraffic traffic;
  std::vector<KnownThen> known;                           ///< in time order
  std::vector<std::pair<std::string, TeamEvent>> events;  ///< by agent, in time order
  std::map<std::string, std::vector<RobotLog>> logs;  ///< by agent: what it knows in the end, without gaps
  std::map<std::string, std::map<std::string, LogExtent>> extents;  ///< of these logs
  std::map<std::string, AgentCounts> counts;                        ///< by agent
  std::size_t estimates = 0, computed = 0;                          ///< computed: not shared
  Stamp settled;                                                    ///< since when nobody lacks a record
  Stamp end;
};

struct VirtualTeamSetup {
  int dimension = 2;
  const RunParams& run;
  AgentParams agent = {};
  NetworkFaults network = {};
  std::size_t solvers = kMaxTeam;  ///< the first robots; others take their solutions
  std::function<std::unique_ptr<AgentStore>(const std::string&)> store = {};
  ErrorOf error_of = {};
};

/// What an agent knows now.
KnownThen known_then(const Agent& agent, Stamp now, std::uint64_t said, const ErrorOf& error_of);
std::map<std::string, std::map<std::string, std::size_t>> refused_by(const Agent& agent);

/// Until every agent that runs knows all, or nothing more comes.
TeamRun run_team(const std::vector<ScriptedRobot>& robots, const VirtualTeamSetup& setup,
                 const Progress& progress = {});

}  // namespace radioslam

// One robot of a team without a server: every robot runs one.
//
// Values in, values out: no clock, thread, socket or file. Whoever runs it calls, at most every 0.1 s,
//   say, add_cloud    what the robot's front end said since
//   hear              every message that came
//   change, note_kept what the journal must have before it is sent
//   step              messages to be sent, what the user should know, and work to be done elsewhere
//   done              what that work gave
// Robots that have the same records come to the same estimate. A robot that does not solve takes another's
// solution.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/records/journal_change.hpp"
#include "radioslam/team/agent_estimate.hpp"
#include "radioslam/team/agent_scans.hpp"
#include "radioslam/team/known_logs.hpp"
#include "radioslam/team/messages.hpp"
#include "radioslam/team/peers.hpp"

namespace radioslam {

struct AgentParams {
  double bytes_s = 0;  ///< largest number of bytes a second to each peer; 0: no bound
  bool solves = true;  ///< else it takes another robot's solution
  StreamParams stream;
};

/// What a journal has of an agent.
struct AgentMemory {
  std::uint32_t life = 0;
  std::vector<std::pair<std::string, KnownLog>> logs = {};
  std::uint32_t next_life = 0;  ///< where others know more of this life than the journal; 0: none
  std::function<std::optional<std::string>(const std::string& key)> state = {};  ///< JournalChange::state
};

struct SentMessage {
  std::string to;        ///< empty: whoever hears it
  std::size_t kind = 0;  ///< of AgentMessage
  std::string bytes;
};

struct AgentStep {
  std::vector<SentMessage> messages;
  std::vector<TeamEvent> events;
  std::optional<EstimateJob> job;
  std::optional<ScanJob> scan_job;
};

class Agent {
 public:
  /// `dimension`: of the mission. Keeps a reference to the parameters of the estimate.
  Agent(std::string name, int dimension, const RunParams& run, const AgentParams& params,
        const AgentMemory& memory);

  /// The front end's next record, encoded.
  void say(std::string record);
  /// Its scanner, and the scans of its keyframes.
  void set_scanner(const ScannerFacts& scanner) { scans_.set_scanner(scanner); }
  void add_cloud(Stamp keyframe, StoredCloud cloud) { scans_.add(keyframe, std::move(cloud)); }
  /// Any bytes, from a peer by the name under which the network knows it.
  void hear(const std::string& peer, std::string_view bytes, Stamp now);
  void done(const AnyGrownEstimate& result, Stamp now);
  void done(const ScanResult& result);

  /// What is to be kept before it is sent, and then that it is kept.
  JournalChange change() const;
  void note_kept();

  AgentStep step(Stamp now);

  const std::string& name() const { return name_; }
  const KnownLogs& logs() const { return logs_; }
  const std::map<std::string, Peer>& peers() const { return peers_; }
  const AgentEstimate& estimate() const { return *estimate_; }
  /// Whether it looks for closures among the scans that it has.
  bool is_busy() const { return scans_.is_busy(); }
  /// Its own and those of others that it has.
  std::size_t clouds() const { return scans_.clouds(); }
  const AgentScans& scans() const { return scans_; }
  /// Where the robots are: by its own estimate, or by the solution that it took.
  PublishedFrame frame_of(const std::string& robot) const;

 private:
  void take(const std::string& peer, const Digest& digest, Stamp now);
  void take(const std::string& peer, const RecordsMessage& records, Stamp now);
  void take(const std::string& peer, const Want& want, Stamp now);
  void take(const std::string& peer, const CloudWant& want, Stamp now);
  void take(const std::string& peer, const CloudMessage& cloud, Stamp now);
  void take(const std::string& peer, const SolutionMessage& solution, Stamp now);

  void remember_scans(const AgentMemory& memory);
  void begin_life(const std::string& peer, const LogExtent& own, Stamp now);
  void refuse(const std::string& peer, const std::string& what, std::size_t times, Stamp now);
  void ask(Stamp now);
  void tell_estimate();
  void restart_estimate();
  void note_waiting(const std::string& name, Peer& peer, Stamp now);
  void send_clouds(const std::string& name, Peer& peer, AgentStep& step);
  void send_digest(Stamp now, AgentStep& step);
  void send_solution(Stamp now, AgentStep& step);
  void send_to(const std::string& name, Peer& peer, bool pushes, AgentStep& step);
  bool send(const std::string& to, Peer& peer, const AgentMessage& message, AgentStep& step);
  bool add_records(const std::string& to, Peer& peer, const std::string& robot, std::uint64_t& first,
                   std::uint64_t end, RecordsMessage& message, AgentStep& step);

  std::string name_;
  int dimension_;
  const RunParams& run_;
  AgentParams params_;
  std::uint32_t next_life_;
  KnownLogs logs_;
  std::map<std::string, Peer> peers_;
  Asking asking_;
  AgentScans scans_;
  std::map<std::string, Want> wants_;  ///< by whom they are asked of, until they are sent
  std::map<std::string, CloudWant> cloud_wants_;
  std::optional<Stamp> digest_sent_, own_sent_, asked_;
  std::unique_ptr<AgentEstimate> estimate_;
  std::map<std::string, std::uint64_t> estimated_;  ///< records that the estimate has, by robot
  std::optional<SolutionMessage> taken_;
  bool has_news_ = true;       ///< that the estimate does not have
  bool has_solution_ = false;  ///< that others do not have
  std::vector<TeamEvent> events_;
};

}  // namespace radioslam

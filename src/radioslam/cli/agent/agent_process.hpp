// A robot's agent as a program of its own: the agent in the thread that calls, its front end, a worker for
// its jobs, and DDS in threads of theirs, which only put into an inbox.
//
// Of a recorded mission it ends when that is over and, for kQuiet_s of the mission, it has learned nothing
// and all that it hears knew the same, at the latest kSettle_s after; robots of the mission that were never
// heard are waited for that long. A machine that is busy gets some seconds of its own in either case. A robot
// that measures ends when it is asked to.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/cli/agent/agent_publisher.hpp"
#include "radioslam/cli/agent/front_end_thread.hpp"
#include "radioslam/cli/agent/live_page.hpp"
#include "radioslam/cli/agent/outbox.hpp"
#include "radioslam/cli/agent/worker.hpp"
#include "radioslam/ros_node/ros_subscriptions.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {

struct AgentProcessSetup {
  std::string robot;
  int dimension = 2;
  const RunParams& run;
  std::optional<Stamp> end = {};       ///< of the recorded mission
  std::vector<std::string> team = {};  ///< robots that are waited for in the end
  AgentParams agent = {};
  ErrorOf error_of = {};
  std::function<void(const std::string& robot, const TeamEvent&)> say = {};  ///< what the user should know
  std::function<bool()> is_to_conclude = {};  ///< with what is known; no more samples come then
  RosSubscriptions* subscriptions = nullptr;  ///< of a robot that measures
  AgentPublisher* publisher = nullptr;        ///< of one that shows what it knows
  LivePage* page = nullptr;                   ///< that shows it, if any
};

/// What the robot has said before; nothing if its program was never started.
std::optional<LogBefore> log_before(const AgentStore& store, const std::string& robot);

class AgentProcess {
 public:
  static constexpr double kQuiet_s = 15, kSettle_s = 180;

  /// Keeps references. The domain is used by the thread that calls live() alone.
  AgentProcess(const AgentProcessSetup& setup, AgentStore& store, const MissionClock& clock,
               DdsDomain& domain, SampleSource& source);
  ~AgentProcess();

  /// What this one agent knows in the end, and how it came to be known.
  TeamRun live();

 private:
  void take(Arrival arrival, Stamp now);
  void hear(const TeamMessage& message, Stamp now);
  void take(FrontEndNews news, Stamp now);
  void step(Stamp now);
  void commit();
  void say(TeamEvent event);
  void say_once(bool is_so, const std::string& what, Stamp now);
  void look_around(Stamp now);
  void observe(Stamp now);
  void note_changes();
  bool is_settled(Stamp now) const;
  std::uint64_t known_records() const;

  const AgentProcessSetup& setup_;
  AgentStore& store_;
  const MissionClock& clock_;
  std::string name_;
  std::optional<LogBefore> before_;
  std::string recorded_;  ///< not kept yet
  Agent agent_;
  Inbox inbox_;
  DdsDomain& domain_;
  TeamChannel channel_;
  Outbox outbox_;
  FrontEndThread front_end_;
  Worker worker_;
  TeamRun run_;
  TeamTraffic received_;
  std::set<std::string> said_;
  std::optional<Stamp> committed_, observed_;
  std::optional<SteadyClock::time_point> committed_at_, looked_,
      over_;  ///< the latter: the recording, and the mission
  Stamp changed_;
  SteadyClock::time_point changed_at_;
  std::uint64_t known_ = 0;  ///< records and clouds
  bool is_recording_over_ = false, is_concluding_ = false;
};

}  // namespace radioslam::cli

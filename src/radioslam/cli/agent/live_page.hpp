// The page of an agent while it runs: a thread that turns what the agent knows, once a second, into what
// changes on the page, and a server. Neither is waited for by the agent.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "radioslam/cli/agent/live_view.hpp"
#include "radioslam/cli/agent/mission_clock.hpp"
#include "radioslam/io/live/live_server.hpp"
#include "radioslam/report/live/live_changes.hpp"

namespace radioslam::cli {

struct LivePageSetup {
  LiveAddress address;
  std::string token;  ///< empty: none is asked for
  std::string robot;
  int dimension = 2;
  Stamp start;  ///< of the mission
  double rate = 1;
};

class LivePage {
 public:
  /// Keeps a reference to the parameters. Refuses what LiveServer refuses.
  LivePage(LivePageSetup setup, const RunParams& params);
  ~LivePage();
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  std::string url() const { return url_of(server_.address(), setup_.token); }
  /// A second after the last one.
  bool is_due() const { return SteadyClock::now() >= due_; }
  void show(const Agent& agent, const TeamRun& run, const TeamTraffic& sent, const TeamTraffic& received,
            Stamp now);
  /// The agent has ended.
  void end();

 private:
  void run();
  void publish(AgentView view);

  LivePageSetup setup_;
  std::shared_ptr<LiveFeed> feed_ = std::make_shared<LiveFeed>();
  LiveServer server_;
  AgentViewer viewer_;
  SteadyClock::time_point due_ = SteadyClock::now();
  LiveView live_;
  LiveChanges changes_;
  std::size_t unread_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<AgentView> next_;
  bool is_ending_ = false;
  std::thread thread_;  // last, as it uses the others
};

}  // namespace radioslam::cli

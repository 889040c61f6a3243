// A thread that does the jobs of a robot's agent, one after the other.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "radioslam/cli/agent/inbox.hpp"

namespace radioslam::cli {

class Worker {
 public:
  /// What the jobs give is put there.
  explicit Worker(Inbox& inbox);
  /// The job that is being done is brought to its end, others are not begun.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void start(std::function<Arrival()> job);

 private:
  void run();

  Inbox& inbox_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<Arrival()>> jobs_;
  bool is_ending_ = false;
  std::thread thread_;  // last, as it uses the others
};

}  // namespace radioslam::cli

#include "radioslam/cli/agent/worker.hpp"

#include <utility>

namespace radioslam::cli {

Worker::Worker(Inbox& inbox) : inbox_(inbox), thread_([this] { run(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void Worker::start(std::function<Arrival()> job) {
  const std::lock_guard lock(mutex_);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Worker::run() {
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_ending_ || !jobs_.empty(); });
    if (is_ending_) return;
    const auto job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    try {
      inbox_.push(job());
    } catch (...) {
      inbox_.push(std::current_exception());
    }
  }
}

}  // namespace radioslam::cli

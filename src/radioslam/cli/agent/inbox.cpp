#include "radioslam/cli/agent/inbox.hpp"

namespace radioslam::cli {
namespace {

constexpr std::size_t kShares = 4;  // a robot's largest is one of so many

}  // namespace

bool Inbox::has_room(const TeamMessage& message) {
  if (of_all_.messages >= kMostMessages || of_all_.bytes + message.octets.size() > kMostBytes) return false;
  const Waiting& of_robot = of_robot_[message.from];
  return of_robot.messages < kMostMessages / kShares &&
         of_robot.bytes + message.octets.size() <= kMostBytes / kShares;
}

void Inbox::hear(TeamMessage message) {
  const std::lock_guard lock(mutex_);
  if (is_closed_) return;
  if (!has_room(message)) {
    const bool is_counted = left_out_.contains(message.from) || left_out_.size() < kMaxTeam;
    ++left_out_[is_counted ? message.from : std::string()];
    return;
  }
  for (Waiting* waiting : {&of_all_, &of_robot_[message.from]}) {
    ++waiting->messages;
    waiting->bytes += message.octets.size();
  }
  waiting_.emplace_back(std::move(message));
  arrived_.notify_one();
}

void Inbox::push(Arrival arrival) {
  std::unique_lock lock(mutex_);
  taken_.wait(lock, [this] { return is_closed_ || news_ < kMostNews; });
  if (is_closed_) return;
  ++news_;
  waiting_.push_back(std::move(arrival));
  arrived_.notify_one();
}

std::deque<Arrival> Inbox::take(SteadyClock::time_point until) {
  std::unique_lock lock(mutex_);
  arrived_.wait_until(lock, until, [this] { return !waiting_.empty(); });
  of_all_ = {};
  of_robot_.clear();
  news_ = 0;
  taken_.notify_all();
  return std::exchange(waiting_, {});
}

std::map<std::string, std::size_t> Inbox::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_;
}

void Inbox::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  taken_.notify_all();
}

}  // namespace radioslam::cli

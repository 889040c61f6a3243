#include "radioslam/cli/agent/ros_source.hpp"

#include <chrono>
#include <utility>

#include "radioslam/ros_node/ros_subscriptions.hpp"

namespace radioslam::cli {
namespace {

constexpr std::chrono::milliseconds kLook{50};

}  // namespace

void RosSource::add(RosArrival arrival) {
  const std::lock_guard lock(mutex_);
  if (is_concluded_) return;
  bytes_ += arrival.cdr.size();
  arrivals_.push_back(std::move(arrival));
  for (; bytes_ > kMostBytes || arrivals_.size() > kMostMessages; arrivals_.pop_front()) {
    bytes_ -= arrivals_.front().cdr.size();
    is_behind_ = true;
  }
  changed_.notify_one();
}

void RosSource::conclude() {
  const std::lock_guard lock(mutex_);
  is_concluded_ = true;
  changed_.notify_all();
}

/// Reads what has come, or comes soon; false once nothing more comes.
bool RosSource::read_arrivals() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kLook, [this] { return is_concluded_ || !arrivals_.empty(); });
  std::deque<RosArrival> arrivals = std::exchange(arrivals_, {});
  bytes_ = 0;
  const bool goes_on = !is_concluded_, is_behind = is_behind_;
  lock.unlock();
  for (RosArrival& arrival : arrivals) samples_.take(std::move(arrival));
  samples_.advance(host_time());
  say_notes(is_behind);
  return goes_on;
}

void RosSource::say_notes(bool is_behind) {
  for (std::string& note : samples_.take_notes()) say(std::move(note));
  if (is_behind && !std::exchange(is_behind_said_, true))
    say("does not keep up with its sensors, the oldest messages are left out; a lower rate or fewer points "
        "of its scanner help");
}

std::optional<MotionSources> RosSource::begin() {
  while (!samples_.sources())
    if (!read_arrivals()) break;
  return samples_.sources();
}

std::optional<Sample> RosSource::next() {
  bool goes_on = true;
  while (ready_.empty() && goes_on) {
    goes_on = read_arrivals();
    for (Sample& sample : samples_.take_samples()) ready_.push_back(std::move(sample));
  }
  if (ready_.empty()) return std::nullopt;
  Sample sample = std::move(ready_.front());
  ready_.pop_front();
  return sample;
}

BodyPose RosSource::published(const OnlinePose& pose) const {
  return {pose.stamp, pose.T_start_body, samples_.body_frame(), samples_.odometry_frame(),
          samples_.odometry_at(pose.stamp)};
}

}  // namespace radioslam::cli

#include "radioslam/cli/agent/recorded_source.hpp"

namespace radioslam::cli {

RecordedSource::RecordedSource(const Mission& mission, RobotIndex self, bool goes_on,
                               const MissionClock& clock)
    : mission_(mission), self_(self), goes_on_(goes_on), clock_(clock), samples_(mission, self) {}

std::optional<MotionSources> RecordedSource::begin() {
  if (goes_on_) samples_.skip_before(clock_.now());
  return sources_of(mission_.robots[self_.index()]);
}

std::optional<Sample> RecordedSource::next() {
  const auto stamp = samples_.next();
  if (!stamp) return std::nullopt;
  std::unique_lock lock(mutex_);
  if (concluded_.wait_until(lock, clock_.when(*stamp), [this] { return is_concluded_; })) return std::nullopt;
  lock.unlock();
  return samples_.take();
}

void RecordedSource::conclude() {
  const std::lock_guard lock(mutex_);
  is_concluded_ = true;
  concluded_.notify_all();
}

}  // namespace radioslam::cli

// The mission's time as it goes by: that of a team that replays its recordings, or what a clock shows.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "radioslam/base/stamp.hpp"

namespace radioslam::cli {

using SteadyClock = std::chrono::steady_clock;

/// The host's clock, which the team's robots share: nanoseconds since 1970.
inline Stamp time_of_host() {
  return {std::chrono::duration_cast<std::chrono::nanoseconds>(
              std::chrono::system_clock::now().time_since_epoch())
              .count()};
}

class MissionClock {
 public:
  /// begin + rate x (time of the host - start); does not jump when the host's clock is set.
  MissionClock(Stamp begin, Stamp start, double rate)
      : begin_(begin),
        rate_(rate),
        start_(SteadyClock::now() + std::chrono::nanoseconds(start.ns - time_of_host().ns)) {}

  /// What `shown` gives, which any thread may call.
  explicit MissionClock(std::function<Stamp()> shown)
      : begin_(shown()), rate_(1), start_(SteadyClock::now()), shown_(std::move(shown)) {}

  double rate() const { return rate_; }
  Stamp begin() const { return begin_; }
  Stamp now() const {
    if (shown_) return shown_();
    const std::chrono::duration<double> since = SteadyClock::now() - start_;
    return {begin_.ns + Stamp::from_seconds(rate_ * since.count()).ns};
  }
  SteadyClock::time_point when(Stamp stamp) const {
    return start_ + std::chrono::duration_cast<SteadyClock::duration>(
                        std::chrono::duration<double>(seconds_between(begin_, stamp) / rate_));
  }

 private:
  Stamp begin_;
  double rate_;
  SteadyClock::time_point start_;
  std::function<Stamp()> shown_ = {};
};

}  // namespace radioslam::cli

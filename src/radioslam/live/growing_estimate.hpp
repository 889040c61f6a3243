// What is known of a team's logs as they grow, and the last estimate made of it (stream_effort.hpp).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/live/scans_so_far.hpp"
#include "radioslam/live/stream_effort.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/records/mission_of_logs.hpp"

namespace radioslam {

/// An estimate that is due.
struct DueEstimate {
  LoggedMission logged;
  Effort effort = Effort::kAlign;
  Stamp at;
  KnownCounts known;
};

template <class Pose>
class GrowingEstimate {
 public:
  using Solution = std::shared_ptr<const TeamSolution<Pose>>;

  explicit GrowingEstimate(const StreamParams& stream) : stream_(stream) {}

  /// The next record of a robot's log, when it comes to be known.
  void hear(const std::string& robot, Record record, Stamp now);
  const KnownCounts& known() const { return known_; }
  /// By the robots' names, as their logs say them.
  const std::map<std::string, LoggedKeyframes>& keyframes() const { return keyframes_; }

  /// The estimate that is due, at most one a second.
  std::optional<DueEstimate> due(Stamp now);
  /// What was estimated.
  void take(const DueEstimate& due, Solution solution);
  /// The last estimate; null before the first.
  const Solution& last() const { return last_; }

 private:
  void count(LoggedKeyframes& robot, const Record& record);

  StreamParams stream_;
  GrowingLogs logs_;
  KnownCounts known_;
  EffortState state_;
  Stamp considered_;
  std::map<std::string, LoggedKeyframes> keyframes_;
  Solution last_;
};

}  // namespace radioslam

// What is known of a team's logs as they grow, and the last estimate made of it (stream_effort.hpp).
#pragma once

#include <functional>
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

/// What is known of a team at a time, when an estimate may be due.
template <class Pose>
struct EstimateRequest {
  GrowingLogs logs;
  KnownCounts known;
  EffortState state;
  StreamParams stream;
  std::shared_ptr<const TeamSolution<Pose>> last;  ///< null before the first
  Stamp at;
};

/// What became of a request.
template <class Pose>
struct GrownEstimate {
  KnownCounts known;
  Stamp at;
  std::shared_ptr<const TeamSolution<Pose>> solution;  ///< null where none was due
};

/// Estimates the team, if that is due. `scans_of`: what scans say, asked only where closures are judged.
template <class Pose>
GrownEstimate<Pose> estimate(const EstimateRequest<Pose>& request, const RunParams& params,
                             const std::function<MeasuredScans(const LoggedMission&)>& scans_of = {});

template <class Pose>
class GrowingEstimate {
 public:
  using Solution = std::shared_ptr<const TeamSolution<Pose>>;

  explicit GrowingEstimate(const StreamParams& stream) : stream_(stream) {}

  /// The next record of a robot's log, when it comes to be known.
  void hear(const std::string& robot, Record record, Stamp now);
  const KnownCounts& known() const { return known_; }
  const GrowingLogs& logs() const { return logs_; }
  /// By the robots' names, as their logs say them.
  const std::map<std::string, LoggedKeyframes>& keyframes() const { return keyframes_; }

  /// What to estimate from where an estimate may be due, at most one a second.
  std::optional<EstimateRequest<Pose>> request(Stamp now);
  void take(GrownEstimate<Pose> estimate);
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

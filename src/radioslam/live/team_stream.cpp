#include "radioslam/live/team_stream.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "radioslam/live/growing_estimate.hpp"
#include "radioslam/live/scans_so_far.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kMeasured_s = 5;  // between comparisons with the truth

/// An estimate is soon made again: each searches places in one round.
RunParams in_one_round(RunParams params) {
  params.places.rounds = 1;
  return params;
}

/// A record when it is known, by its robot.
struct Said {
  Stamp known;
  std::size_t robot = 0, number = 0;

  auto operator<=>(const Said&) const = default;
};

std::vector<Said> in_order(const std::vector<ReplayedRobot>& robots) {
  std::vector<Said> all;
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (std::size_t k = 0; k < robots[r].known.size(); ++k) all.push_back({robots[r].known[k], r, k});
  std::sort(all.begin(), all.end());
  return all;
}

template <class Pose>
class TeamStream {
 public:
  TeamStream(const Mission& mission, const std::vector<ReplayedRobot>& robots, const RunParams& params,
             const StreamParams& stream, const ErrorOf& error_of, const Progress& progress)
      : mission_(mission),
        robots_(robots),
        params_(in_one_round(params)),
        error_of_(error_of),
        progress_(progress),
        known_(stream) {
    for (std::size_t r = 0; r < robots.size(); ++r) {
      scans_.emplace(mission.robots[r].id, ScansSoFar(robots[r]));
      numbers_[mission.robots[r].id] = r;
    }
  }

  StreamedTeam run() {
    const std::vector<Said> said = in_order(robots_);
    for (std::size_t k = 0; k < said.size(); ++k) {
      if (k > 0 && said[k].known != said[k - 1].known) consider(said[k - 1].known);
      hear(said[k]);
      report_progress(progress_, "team", static_cast<double>(k) / static_cast<double>(said.size()));
    }
    return std::move(streamed_);
  }

 private:
  void hear(const Said& said) {
    const std::string& id = mission_.robots[said.robot].id;
    auto record = decode_record(robots_[said.robot].log.records[said.number]);
    if (!record) return;
    const auto* keyframe = std::get_if<KeyframeRecord>(&*record);
    const std::optional<std::uint32_t> number = keyframe ? std::optional(keyframe->number) : std::nullopt;
    known_.hear(id, *std::move(record), said.known);
    if (!number) return;
    std::optional<std::size_t> estimate;
    if (!streamed_.estimates.empty()) estimate = streamed_.estimates.size() - 1;
    const PublishedFrame frame = frames_.of(id);
    const StampedPose<SE3>& last = known_.keyframes().at(id).said.back();
    streamed_.keyframes.push_back({said.robot, *number, last.stamp,
                                   frame.T_frame_start * in_dimension<Pose>(last.pose),
                                   numbers_.at(frame.frame), estimate});
  }

  /// Estimates the team if that is due.
  void consider(Stamp now) {
    const auto begin = std::chrono::steady_clock::now();
    const auto request = known_.request(now);
    if (!request) return;
    auto grown = estimate<Pose>(*request, params_, [&](const LoggedMission& logged) {
      return measured_so_far(scans_, logged.mission.robots, known_.keyframes(),
                             loop_search(params_.scans, params_.places.descriptors, mission_.dimension),
                             progress_);
    });
    const bool is_made = grown.solution != nullptr;
    known_.take(std::move(grown));
    if (!is_made) return;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (TeamEvent& event : frames_.move_to(known_.last()->team, now, known_.keyframes()))
      streamed_.events.push_back(std::move(event));
    describe(now, seconds);
  }

  void describe(Stamp now, double seconds) {
    const TeamEstimate<Pose>& team = known_.last()->team;
    OnlineEstimate estimate{
        now, known_.last()->effort, seconds, known_.known().keyframes, team.alignment.weight, {}, {}};
    for (const Robot& robot : mission_.robots)
      estimate.frame.push_back(numbers_.at(frames_.of(robot.id).frame));
    if (error_of_ && (estimate.effort != Effort::kExtend || seconds_between(measured_, now) >= kMeasured_s)) {
      estimate.error_m = error_of_(largest_frame(team, frames_));
      measured_ = now;
    }
    streamed_.estimates.push_back(std::move(estimate));
  }

  const Mission& mission_;
  const std::vector<ReplayedRobot>& robots_;
  const RunParams params_;
  const ErrorOf& error_of_;
  const Progress& progress_;
  GrowingEstimate<Pose> known_;
  Stamp measured_;
  PublishedFrames frames_;
  std::map<std::string, ScansSoFar> scans_;
  std::map<std::string, std::size_t> numbers_;  ///< of the mission's robots
  StreamedTeam streamed_;
};

}  // namespace

StreamedTeam stream_team(const Mission& mission, const std::vector<ReplayedRobot>& robots,
                         const RunParams& params, const StreamParams& stream, const ErrorOf& error_of,
                         const Progress& progress) {
  return mission.dimension == 2 ? TeamStream<SE2>(mission, robots, params, stream, error_of, progress).run()
                                : TeamStream<SE3>(mission, robots, params, stream, error_of, progress).run();
}

}  // namespace radioslam

#include "radioslam/live/team_stream.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>

#include "radioslam/live/link_evidence.hpp"
#include "radioslam/live/scans_so_far.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kMeasured_s = 5;  // between comparisons with the truth

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

std::vector<std::string> ids_of(const Mission& mission) {
  std::vector<std::string> ids;
  for (const Robot& robot : mission.robots) ids.push_back(robot.id);
  return ids;
}

template <class Pose>
class TeamStream {
 public:
  TeamStream(const Mission& mission, const std::vector<ReplayedRobot>& robots, const RunParams& params,
             const StreamParams& stream, const ErrorOf& error_of, const Progress& progress)
      : mission_(mission),
        robots_(robots),
        params_(params),
        stream_(stream),
        error_of_(error_of),
        progress_(progress),
        keyframes_(robots.size()),
        frames_(ids_of(mission)) {
    for (const ReplayedRobot& robot : robots) scans_.emplace_back(robot);
  }

  StreamedTeam run() {
    const std::vector<Said> said = in_order(robots_);
    if (!said.empty()) state_.begin = said.front().known;
    for (std::size_t k = 0; k < said.size(); ++k) {
      if (k > 0 && said[k].known != said[k - 1].known) consider(said[k - 1].known);
      hear(said[k]);
      report_progress(progress_, "team", static_cast<double>(k) / static_cast<double>(said.size()));
    }
    return std::move(streamed_);
  }

 private:
  void hear(const Said& said) {
    const std::string& bytes = robots_[said.robot].log.records[said.number];
    ++known_.records;
    auto record = decode_record(bytes);
    if (!record) return;
    std::visit([&](const auto& of) { count(said.robot, of); }, *record);
    logs_.add(mission_.robots[said.robot].id, *std::move(record));
  }

  void count(std::size_t robot, const KeyframeRecord& keyframe) {
    ++known_.keyframes;
    LoggedKeyframes& known = keyframes_[robot];
    known.add(keyframe);
    std::optional<std::size_t> estimate;
    if (!streamed_.estimates.empty()) estimate = streamed_.estimates.size() - 1;
    const PublishedFrame& frame = frames_.of(robot);
    streamed_.keyframes.push_back({robot, keyframe.number, keyframe.stamp,
                                   frame.T_frame_start * in_dimension<Pose>(known.said.back().pose),
                                   frame.frame, estimate});
  }
  void count(std::size_t robot, const AmendmentRecord& amendment) { keyframes_[robot].add(amendment); }
  void count(std::size_t, const RangeRecord&) { ++known_.links; }
  void count(std::size_t, const AnglesRecord&) { ++known_.links; }
  void count(std::size_t, const FingerprintRecord&) { ++known_.fingerprints; }
  void count(std::size_t, const ClosureRecord&) { ++known_.closures; }
  template <class Other>
  void count(std::size_t, const Other&) {}

  /// Estimates the team if that is due.
  void consider(Stamp now) {
    if (seconds_between(considered_, now) < 1 && state_.any) return;
    considered_ = now;
    if (!due_effort(state_, now, known_, stream_)) return;
    const auto begin = std::chrono::steady_clock::now();
    LoggedMission logged;
    try {
      logged = logs_.mission();
    } catch (const std::runtime_error&) {  // no robot has moved yet
      return;
    }
    known_.unjoined_links = unjoined_links(logged.mission, solution_ ? &solution_->team : nullptr);
    const auto effort = due_effort(state_, now, known_, stream_);
    if (!effort) return;
    const MeasuredScans scans = *effort == Effort::kExtend
                                    ? MeasuredScans{}
                                    : measured_so_far(scans_, keyframes_, in_mission(logged.mission.robots),
                                                      loop_search(), progress_);
    solution_ = estimate<Pose>({logged, scans}, solution_ ? &*solution_ : nullptr, *effort, params_,
                               {.lists_overlaps = false});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state_.weight = solution_->weight_by_links;
    state_.is_contradicted = fits_worse_of_late(solution_->team);
    state_.note(solution_->effort, now, known_);
    for (TeamEvent& event : frames_.move_to(solution_->team, now, keyframes_))
      streamed_.events.push_back(std::move(event));
    describe(now, seconds);
  }

  ScanLoopSearch loop_search() const {
    return {params_.scans.loops,        params_.scans.lidar.map,
            params_.scans.search,       params_.scans.lidar.registration,
            params_.places.descriptors, mission_.dimension == 3 ? Storeys::kSeveral : Storeys::kOne};
  }

  /// The robot of the mission that each robot of the logs is.
  std::vector<std::size_t> in_mission(const auto& robots) const {
    std::vector<std::size_t> numbers;
    for (const auto& robot : robots)
      for (std::size_t r = 0; r < mission_.robots.size(); ++r)
        if (mission_.robots[r].id == robot.id) numbers.push_back(r);
    return numbers;
  }

  void describe(Stamp now, double seconds) {
    OnlineEstimate estimate{
        now, solution_->effort, seconds, known_.keyframes, solution_->team.alignment.weight, {}, {}};
    std::map<std::size_t, std::vector<std::size_t>> members;  // robots of the graph, by frame
    for (std::size_t r = 0; r < robots_.size(); ++r) estimate.frame.push_back(frames_.of(r).frame);
    const auto numbers = in_mission(solution_->team.joint.robots);
    for (std::size_t r = 0; r < numbers.size(); ++r) members[estimate.frame[numbers[r]]].push_back(r);
    if (error_of_ && (estimate.effort != Effort::kExtend || seconds_between(measured_, now) >= kMeasured_s)) {
      const auto largest = std::max_element(members.begin(), members.end(), [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
      });
      estimate.error_m = error_of(largest->second);
      measured_ = now;
    }
    streamed_.estimates.push_back(std::move(estimate));
  }

  std::optional<double> error_of(const std::vector<std::size_t>& robots) const {
    const JointGraph<Pose>& joint = solution_->team.joint;
    std::vector<EstimatedTrajectory> trajectories;
    for (const std::size_t r : robots) {
      const RobotVariables& robot = joint.robots[r];
      std::vector<StampedPose<SE3>> poses;
      for (std::size_t k = 0; k < robot.poses.size(); ++k)
        poses.push_back({robot.stamps[k], as_se3(joint.team.graph.poses[robot.poses[k].index()], 0)});
      trajectories.push_back({robot.id, Trajectory<SE3>(std::move(poses))});
    }
    return error_of_(trajectories);
  }

  const Mission& mission_;
  const std::vector<ReplayedRobot>& robots_;
  const RunParams& params_;
  const StreamParams& stream_;
  const ErrorOf& error_of_;
  const Progress& progress_;
  GrowingLogs logs_;
  KnownCounts known_;
  EffortState state_;
  Stamp considered_, measured_;
  std::vector<LoggedKeyframes> keyframes_;
  PublishedFrames frames_;
  std::vector<ScansSoFar> scans_;
  std::optional<TeamSolution<Pose>> solution_;
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

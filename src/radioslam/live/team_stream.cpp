#include "radioslam/live/team_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

#include "radioslam/joint/team_continuation.hpp"
#include "radioslam/live/scans_so_far.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kCertain = 0.95;  // weight from which robots share a frame
constexpr double kMoved_m = 1, kMoved_rad = 0.1;
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

/// A pose as the estimate has it: in the plane, at height 0.
template <class Pose>
SE3 in_dimension(const SE3& pose) {
  return as_se3(pose_as<Pose>(pose), 0);
}

/// Where a robot's odometry starts in its frame.
struct PublishedFrame {
  std::size_t frame = 0;  ///< its first robot
  SE3 T_frame_start;
};

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
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
        keyframes_(robots.size()) {
    for (std::size_t r = 0; r < robots.size(); ++r) {
      scans_.emplace_back(robots[r]);
      frames_.push_back({r, {}});
    }
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
    const PublishedFrame& frame = frames_[robot];
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
    known_.unjoined_links = unjoined_links(logged.mission);
    const auto effort = due_effort(state_, now, known_, stream_);
    if (!effort) return;
    const MeasuredScans scans = *effort == Effort::kExtend ? MeasuredScans{} : scans_of(logged.mission);
    solution_ = estimate<Pose>({logged, scans}, solution_ ? &*solution_ : nullptr, *effort, params_,
                               {.lists_overlaps = false});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state_.weight = solution_->team.alignment.weight;
    state_.is_contradicted = fits_worse_of_late();
    state_.note(solution_->effort, now, known_);
    publish(now, seconds);
  }

  /// The robot of the mission that each robot of the logs is.
  std::vector<std::size_t> in_mission(const auto& robots) const {
    std::vector<std::size_t> numbers;
    for (const auto& robot : robots)
      for (std::size_t r = 0; r < mission_.robots.size(); ++r)
        if (mission_.robots[r].id == robot.id) numbers.push_back(r);
    return numbers;
  }

  /// With the loops among each robot's scans.
  MeasuredScans scans_of(const Mission& logged) {
    const ScanLoopSearch search{
        params_.scans.loops,        params_.scans.lidar.map,
        params_.scans.search,       params_.scans.lidar.registration,
        params_.places.descriptors, mission_.dimension == 3 ? Storeys::kSeveral : Storeys::kOne};
    MeasuredScans measured;
    const auto numbers = in_mission(logged.robots);
    for (std::size_t r = 0; r < numbers.size(); ++r) {
      ScansSoFar& scans = scans_[numbers[r]];
      auto& of = measured.robots.emplace_back();
      if (!scans.has_any(keyframes_[numbers[r]])) continue;
      of = scans.update(keyframes_[numbers[r]], search, progress_);
      for (const ScanLoop& loop : scans.loops().loops)
        measured.closures.push_back(
            {RobotIndex(r), of->keyframe_stamps[loop.i], of->keyframe_stamps[loop.j], loop});
    }
    return measured;
  }

  /// Links between the two frames of radio with the most of them.
  std::size_t unjoined_links(const Mission& logged) const {
    std::map<std::pair<int, int>, std::size_t> links;
    std::vector<int> frame(logged.robots.size());
    const bool is_aligned = solution_ && !solution_->team.alignment.segments.of_segment.empty();
    for (std::size_t r = 0; r < logged.robots.size(); ++r) {
      frame[r] = -1 - static_cast<int>(r);
      if (!is_aligned) continue;
      const auto& robots = solution_->team.joint.robots;
      for (std::size_t b = 0; b < robots.size(); ++b)
        if (robots[b].id == logged.robots[r].id) frame[r] = solution_->team.alignment.segments.of_segment[b];
    }
    const auto add = [&](RobotIndex i, RobotIndex j) {
      if (i.valid() && j.valid() && frame[i.index()] != frame[j.index()])
        ++links[std::minmax(frame[i.index()], frame[j.index()])];
    };
    for (const RangeMeasurement& range : logged.ranges) add(range.i.robot, range.j.robot);
    for (const AoaMeasurement& angles : logged.aoa_measurements)
      add(angles.receiver, angles.transmitter.robot);
    std::size_t most = 0;
    for (const auto& [pair, count] : links) most = std::max(most, count);
    return most;
  }

  /// Whether the last links within frames have much less weight than all.
  bool fits_worse_of_late() const {
    constexpr std::size_t kLate = 10;
    const JointGraph<Pose>& joint = solution_->team.joint;
    const auto segment_of = segment_of_poses(joint.team);
    const auto& frames = solution_->team.alignment.segments.of_segment;
    if (frames.empty()) return false;
    std::vector<std::pair<Stamp, double>> weights;
    const auto add = [&](const FactorOrigin& origin, double weight) {
      const auto frame = [&](RobotIndex robot) {
        return frames[segment_of[joint.robots[robot.index()].poses.front().index()]];
      };
      if (origin.robot_i.valid() && origin.robot_j.valid() && frame(origin.robot_i) == frame(origin.robot_j))
        weights.emplace_back(origin.stamp_i, weight);
    };
    for (const std::size_t k : factors_of(joint.origins.ranges, FactorSource::kRange))
      add(joint.origins.ranges[k], joint.team.graph.ranges[k].weight);
    for (std::size_t k = 0; k < joint.bearing_weights.size(); ++k)
      add(joint.origins.bearings[k], joint.bearing_weights[k].weight);
    if (weights.size() < 2 * kLate) return false;
    std::stable_sort(weights.begin(), weights.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto mean = [&](std::size_t from) {
      double sum = 0;
      for (std::size_t k = from; k < weights.size(); ++k) sum += weights[k].second;
      return sum / static_cast<double>(weights.size() - from);
    };
    return mean(weights.size() - kLate) < 0.5 * mean(0);
  }

  /// Moves the robots' frames to the estimate, and says what moves by more than a metre.
  void publish(Stamp now, double seconds) {
    const TeamEstimate<Pose>& team = solution_->team;
    const auto numbers = in_mission(team.joint.robots);
    const std::vector<int> component = settled_components(team, kCertain);
    OnlineEstimate estimate{now, solution_->effort, seconds, known_.keyframes, team.alignment.weight, {}, {}};
    for (std::size_t r = 0; r < robots_.size(); ++r) estimate.frame.push_back(r);
    std::map<int, std::vector<std::size_t>> members;  // robots of the graph, by component
    for (std::size_t r = 0; r < component.size(); ++r) members[component[r]].push_back(r);
    std::size_t most = 0;
    std::vector<std::size_t> largest;
    for (const auto& [number, robots] : members) {
      // A frame that is not the graph's own starts where its first robot's odometry does.
      const std::size_t first = *std::min_element(robots.begin(), robots.end(),
                                                  [&](auto a, auto b) { return numbers[a] < numbers[b]; });
      const bool is_own = team.alignment.component[first] == number;
      const SE3 T_frame_graph = is_own ? SE3() : start_of(first, numbers[first]).inverse();
      for (const std::size_t r : robots) {
        estimate.frame[numbers[r]] = numbers[first];
        move(now, numbers[r], {numbers[first], T_frame_graph * start_of(r, numbers[r])});
      }
      if (robots.size() <= most) continue;
      most = robots.size();
      largest = robots;
    }
    if (error_of_ && (estimate.effort != Effort::kExtend || seconds_between(measured_, now) >= kMeasured_s)) {
      estimate.error_m = error_of(largest);
      measured_ = now;
    }
    streamed_.estimates.push_back(std::move(estimate));
  }

  /// Start of the odometry of the graph's robot r, by its last pose.
  SE3 start_of(std::size_t r, std::size_t number) const {
    const RobotVariables& robot = solution_->team.joint.robots[r];
    const SE3 pose = as_se3(solution_->team.joint.team.graph.poses[robot.poses.back().index()], 0);
    const auto& known = keyframes_[number].said;
    const auto at =
        std::lower_bound(known.begin(), known.end(), robot.stamps.back(),
                         [](const auto& keyframe, Stamp stamp) { return keyframe.stamp < stamp; });
    const SE3 odometry = in_dimension<Pose>(at == known.end() ? known.back().pose : at->pose);
    return pose * odometry.inverse();
  }

  void move(Stamp now, std::size_t robot, const PublishedFrame& to) {
    PublishedFrame& frame = frames_[robot];
    const std::string& id = mission_.robots[robot].id;
    const auto say = [&](const std::string& what) {
      streamed_.events.push_back({now, what, frame.frame != to.frame});
    };
    if (frame.frame != to.frame) {
      say(to.frame == robot ? "robot " + id + " is in a frame of its own again: its alignment is ambiguous"
                            : "robot " + id + " is in the frame of robot " + mission_.robots[to.frame].id);
    } else if (robot != to.frame) {
      const SE3 odometry = in_dimension<Pose>(keyframes_[robot].said.back().pose);
      const SE3 moved = (frame.T_frame_start * odometry).inverse() * (to.T_frame_start * odometry);
      const double m = moved.translation().norm(), rad = moved.log().template tail<3>().norm();
      if (m > kMoved_m || rad > kMoved_rad)
        say("robot " + id + " moves by " + rounded(m, 1) + " m and " + rounded(rad * 57.29577951308232, 0) +
            " degrees in the frame of robot " + mission_.robots[to.frame].id);
    }
    frame = to;
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
  std::vector<ScansSoFar> scans_;
  std::vector<PublishedFrame> frames_;
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

#include "radioslam/live/published_frames.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <numbers>
#include <sstream>

#include "radioslam/joint/team_continuation.hpp"

namespace radioslam {
namespace {

constexpr double kCertain = 0.95;  // weight from which robots share a frame
constexpr double kMoved_m = 1, kMoved_rad = 0.1;

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// Start of the odometry of the graph's robot r, by its last pose.
template <class Pose>
SE3 start_of(const JointGraph<Pose>& joint, std::size_t r, const LoggedKeyframes& keyframes) {
  const RobotVariables& robot = joint.robots[r];
  const auto& known = keyframes.said;
  const auto at = std::lower_bound(known.begin(), known.end(), robot.stamps.back(),
                                   [](const auto& keyframe, Stamp stamp) { return keyframe.stamp < stamp; });
  const SE3 odometry = in_dimension<Pose>(at == known.end() ? known.back().pose : at->pose);
  return as_se3(joint.team.graph.poses[robot.poses.back().index()], 0) * odometry.inverse();
}

}  // namespace

PublishedFrames::PublishedFrames(const std::vector<std::string>& robots) : robots_(robots) {
  for (std::size_t r = 0; r < robots.size(); ++r) frames_.push_back({r, {}});
}

template <class Pose>
std::vector<TeamEvent> PublishedFrames::move_to(const TeamEstimate<Pose>& team, Stamp now,
                                                const std::vector<LoggedKeyframes>& keyframes) {
  std::vector<std::size_t> numbers;
  for (const RobotVariables& robot : team.joint.robots) numbers.push_back(number_of(robot.id));
  const std::vector<int> component = settled_components(team, kCertain);
  std::map<int, std::size_t> first;  // robot of the graph, by component
  for (std::size_t r = 0; r < component.size(); ++r) {
    const auto [known, is_new] = first.emplace(component[r], r);
    if (!is_new && numbers[r] < numbers[known->second]) known->second = r;
  }
  std::vector<TeamEvent> events;
  for (std::size_t r = 0; r < component.size(); ++r) {
    // A frame that is not the graph's own starts where its first robot's odometry does.
    const std::size_t of = first.at(component[r]);
    const bool is_own = team.alignment.component[of] == component[r];
    const auto start = [&](std::size_t robot) {
      return start_of(team.joint, robot, keyframes[numbers[robot]]);
    };
    const SE3 T_frame_graph = is_own ? SE3() : start(of).inverse();
    const bool by_closures = !connected_without_matches(team.alignment, RobotIndex(r), RobotIndex(of));
    move(numbers[r], {numbers[of], T_frame_graph * start(r), by_closures}, now,
         in_dimension<Pose>(keyframes[numbers[r]].said.back().pose), events);
  }
  return events;
}

std::size_t PublishedFrames::number_of(const std::string& robot) const {
  return static_cast<std::size_t>(std::find(robots_.begin(), robots_.end(), robot) - robots_.begin());
}

void PublishedFrames::move(std::size_t robot, const PublishedFrame& to, Stamp now, const SE3& odometry,
                           std::vector<TeamEvent>& events) {
  PublishedFrame& frame = frames_[robot];
  const std::string is_in = "robot " + robots_[robot] + " is in the frame of robot " + robots_[to.frame];
  if (frame.frame != to.frame) {
    events.push_back(
        {now,
         to.frame == robot
             ? "robot " + robots_[robot] + " is in a frame of its own again: its alignment is ambiguous"
             : is_in +
                   (to.is_by_closures_alone ? ", by closures alone: places that look alike may deceive" : ""),
         true});
  } else if (robot != to.frame) {
    const SE3 moved = (frame.T_frame_start * odometry).inverse() * (to.T_frame_start * odometry);
    const double m = moved.translation().norm(), rad = moved.log().tail<3>().norm();
    if (m > kMoved_m || rad > kMoved_rad)
      events.push_back({now, "robot " + robots_[robot] + " moves by " + rounded(m, 1) + " m and " +
                                 rounded(rad * 180 / std::numbers::pi, 0) +
                                 " degrees in the frame of robot " + robots_[to.frame]});
    if (frame.is_by_closures_alone && !to.is_by_closures_alone)
      events.push_back({now, is_in + " by more than closures now"});
  }
  frame = to;
}

template std::vector<TeamEvent> PublishedFrames::move_to(const TeamEstimate<SE2>&, Stamp,
                                                         const std::vector<LoggedKeyframes>&);
template std::vector<TeamEvent> PublishedFrames::move_to(const TeamEstimate<SE3>&, Stamp,
                                                         const std::vector<LoggedKeyframes>&);

}  // namespace radioslam

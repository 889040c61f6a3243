#include "radioslam/live/published_frames.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

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

PublishedFrame PublishedFrames::of(const std::string& robot) const {
  const auto found = frames_.find(robot);
  return found == frames_.end() ? PublishedFrame{robot, {}} : found->second;
}

template <class Pose>
std::vector<TeamEvent> PublishedFrames::move_to(const TeamEstimate<Pose>& team, Stamp now,
                                                const std::map<std::string, LoggedKeyframes>& keyframes) {
  const auto& robots = team.joint.robots;
  const std::vector<int> component = settled_components(team, kCertain);
  const bool has_links = has_radio_links(team.joint);
  const auto first = [&](std::size_t r, bool counts_closures) {
    for (std::size_t of = 0; of < r; ++of)
      if (component[of] == component[r] &&
          (counts_closures || connected_without_matches(team.alignment, RobotIndex(r), RobotIndex(of))))
        return of;
    return r;
  };
  std::vector<TeamEvent> events;
  for (std::size_t r = 0; r < component.size(); ++r) {
    // A frame that is not the graph's own starts where its first robot's odometry does.
    const std::size_t by_all = first(r, true), by_links = first(r, false), of = has_links ? by_links : by_all;
    const bool is_own = of == first(of, true) && team.alignment.component[of] == component[r];
    const auto start = [&](std::size_t robot) {
      return start_of(team.joint, robot, keyframes.at(robots[robot].id));
    };
    const SE3 T_frame_graph = is_own ? SE3() : start(of).inverse();
    move(robots[r].id, {robots[of].id, T_frame_graph * start(r), by_all == by_links ? "" : robots[by_all].id},
         now, in_dimension<Pose>(keyframes.at(robots[r].id).said.back().pose), events);
  }
  return events;
}

void PublishedFrames::move(const std::string& robot, PublishedFrame to, Stamp now, const SE3& odometry,
                           std::vector<TeamEvent>& events) {
  const PublishedFrame frame = of(robot);
  const std::string is_in = "robot " + robot + " is in the frame of robot " + to.frame;
  const bool is_by_closures = to.by_closures == to.frame;
  if (frame.frame != to.frame) {
    events.push_back(
        {now,
         to.frame == robot
             ? "robot " + robot + " is in a frame of its own again: its alignment is ambiguous"
             : is_in + (is_by_closures ? ", by closures alone: places that look alike may deceive" : ""),
         true});
  } else if (robot != to.frame) {
    const SE3 moved = (frame.T_frame_start * odometry).inverse() * (to.T_frame_start * odometry);
    const double m = moved.translation().norm(), rad = moved.log().tail<3>().norm();
    if (m > kMoved_m || rad > kMoved_rad)
      events.push_back({now, "robot " + robot + " moves by " + rounded(m, 1) + " m and " +
                                 rounded(rad * 180 / std::numbers::pi, 0) +
                                 " degrees in the frame of robot " + to.frame});
  }
  if (!to.by_closures.empty() && !is_by_closures && frame.by_closures.empty())
    events.push_back({now, "closures alone put robot " + robot + " into the frame of robot " +
                               to.by_closures + ": it stays in its own until radio links agree"});
  frames_[robot] = std::move(to);
}

template <class Pose>
std::vector<EstimatedTrajectory> largest_frame(const TeamEstimate<Pose>& team,
                                               const PublishedFrames& frames) {
  std::map<std::string, std::vector<const RobotVariables*>> members;
  for (const RobotVariables& robot : team.joint.robots) members[frames.of(robot.id).frame].push_back(&robot);
  const auto largest = std::max_element(members.begin(), members.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
  std::vector<EstimatedTrajectory> trajectories;
  if (largest == members.end()) return trajectories;
  for (const RobotVariables* robot : largest->second) {
    std::vector<StampedPose<SE3>> poses;
    for (std::size_t k = 0; k < robot->poses.size(); ++k)
      poses.push_back({robot->stamps[k], as_se3(team.joint.team.graph.poses[robot->poses[k].index()], 0)});
    trajectories.push_back({robot->id, Trajectory<SE3>(std::move(poses))});
  }
  return trajectories;
}

#define RADIOSLAM_PUBLISHED_FRAMES(Pose)                                                                   \
  template std::vector<TeamEvent> PublishedFrames::move_to(const TeamEstimate<Pose>&, Stamp,               \
                                                           const std::map<std::string, LoggedKeyframes>&); \
  template std::vector<EstimatedTrajectory> largest_frame(const TeamEstimate<Pose>&, const PublishedFrames&);
RADIOSLAM_PUBLISHED_FRAMES(SE2)
RADIOSLAM_PUBLISHED_FRAMES(SE3)
#undef RADIOSLAM_PUBLISHED_FRAMES

}  // namespace radioslam

#include "radioslam/joint/joint_graph_from_file.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/joint/antenna_pairs.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

std::size_t robot_of(const TrajectorySegment& segment, const Mission& mission) {
  const auto found = std::find_if(mission.robots.begin(), mission.robots.end(),
                                  [&](const Robot& robot) { return robot.id == segment.robot; });
  RADIOSLAM_CHECK(found != mission.robots.end(),
                  "every trajectory segment belongs to a robot of the mission");
  return static_cast<std::size_t>(found - mission.robots.begin());
}

template <class Pose>
std::vector<FactorOrigin> robots_and_stamps(const JointGraph<Pose>& joint) {
  std::vector<FactorOrigin> of_pose(joint.team.graph.poses.size());
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
    for (std::size_t k = 0; k < joint.team.segments[p].pose_count; ++k) {
      FactorOrigin& origin = of_pose[joint.team.segments[p].first_pose + k];
      origin.robot_i = RobotIndex(joint.robot_of_segment[p]);
      origin.stamp_i = joint.team.segments[p].stamps[k];
    }
  return of_pose;
}

/// Robots all of whose pieces have a known start: their odometry is in the common frame already.
template <class Pose>
void mark_known_starts(JointGraph<Pose>& joint) {
  for (std::size_t r = 0; r < joint.robots.size(); ++r) joint.robots[r].T_common_start = SE3();
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
    if (!joint.team.segments[p].in_common_frame)
      joint.robots[joint.robot_of_segment[p]].T_common_start.reset();
}

}  // namespace

template <class Pose>
JointGraph<Pose> joint_graph_of(const TeamGraph<Pose>& team, const Mission& mission) {
  JointGraph<Pose> joint;
  joint.team = team;
  for (const Robot& robot : mission.robots) {
    RobotVariables& added = joint.robots.emplace_back();
    added.id = robot.id;
    added.lidar_range_m = robot.lidar_range_m;
    added.lidar_view_rad = robot.lidar_view_rad;
  }
  for (const TrajectorySegment& segment : team.segments) {
    joint.robot_of_segment.push_back(robot_of(segment, mission));
    RobotVariables& robot = joint.robots[joint.robot_of_segment.back()];
    for (std::size_t k = 0; k < segment.pose_count; ++k) {
      robot.stamps.push_back(segment.stamps[k]);
      robot.poses.push_back(PoseId(segment.first_pose + k));
      robot.odometry.push_back(as_se3(team.graph.poses[segment.first_pose + k], 0));
    }
  }
  mark_known_starts(joint);
  const auto of_pose = robots_and_stamps(joint);
  const auto origin = [&](FactorSource source, std::size_t measurement, PoseId i, PoseId j) {
    FactorOrigin result;
    result.source = source;
    result.measurement = measurement;
    if (i.valid()) result.robot_i = of_pose[i.index()].robot_i, result.stamp_i = of_pose[i.index()].stamp_i;
    if (j.valid()) result.robot_j = of_pose[j.index()].robot_i, result.stamp_j = of_pose[j.index()].stamp_i;
    return result;
  };
  AntennaPairs pairs(joint.antenna_pairs);
  const auto name = [&](const RangeEnd<Pose>& end) {
    if (!end.pose.valid()) return "landmark " + std::to_string(end.point.index());
    return joint.robots[of_pose[end.pose.index()].robot_i.index()].id;
  };
  for (std::size_t k = 0; k < team.graph.ranges.size(); ++k) {
    const auto& range = team.graph.ranges[k];
    joint.origins.ranges.push_back(origin(FactorSource::kRange, k, range.i.pose, range.j.pose));
    joint.origins.ranges.back().antenna_pair = pairs.index_of(name(range.i), name(range.j));
  }
  for (std::size_t k = 0; k < team.bearings.size(); ++k)
    joint.origins.bearings.push_back(
        origin(FactorSource::kAoa, k, team.bearings[k].i, team.bearings[k].j.pose));
  const auto segment_of = segment_of_poses(team);
  joint.ignored_links = static_cast<std::size_t>(
      std::count_if(team.graph.relative_poses.begin(), team.graph.relative_poses.end(),
                    [&](const auto& f) { return segment_of[f.i.index()] != segment_of[f.j.index()]; }));
  std::erase_if(joint.team.graph.relative_poses,
                [&](const auto& f) { return segment_of[f.i.index()] != segment_of[f.j.index()]; });
  const auto& steps = joint.team.graph.relative_poses;
  for (std::size_t k = 0; k < steps.size(); ++k)
    joint.origins.relative_poses.push_back(origin(FactorSource::kOdometry, k, steps[k].i, steps[k].j));
  return joint;
}

template JointGraph<SE2> joint_graph_of(const TeamGraph<SE2>&, const Mission&);
template JointGraph<SE3> joint_graph_of(const TeamGraph<SE3>&, const Mission&);

}  // namespace radioslam

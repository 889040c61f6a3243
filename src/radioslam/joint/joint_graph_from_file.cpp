#include "radioslam/joint/joint_graph_from_file.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/pose_chart.hpp"
#include "radioslam/joint/links/radio_factors.hpp"

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

/// Odometry comes first in a team that was read from a file: one step from every pose but its segment's last.
template <class Pose>
std::size_t odometry_count(const TeamGraph<Pose>& team) {
  return team.graph.poses.size() - team.segments.size();
}

/// The information of a relative pose near the measured one, for its logarithm.
template <class Pose>
typename Pose::Jacobian of_logarithm(PoseChart chart, const typename Pose::Jacobian& information) {
  const typename Pose::Jacobian derivative = chart_derivative(chart, Pose());
  return normal_matrix(derivative, information);
}

template <class Pose>
void use_logarithm(PoseGraph<Pose>& graph) {
  for (auto& factor : graph.relative_poses)
    factor.information = of_logarithm<Pose>(graph.chart, factor.information);
  for (auto& prior : graph.pose_priors)
    prior.information = of_logarithm<Pose>(graph.chart, prior.information);
  graph.chart = PoseChart::kLogarithm;
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
  joint.team.graph.relative_poses.resize(odometry_count(team));
  for (std::size_t k = 0; k < joint.team.graph.relative_poses.size(); ++k) {
    const auto& step = team.graph.relative_poses[k];
    joint.origins.relative_poses.push_back(origin(FactorSource::kOdometry, k, step.i, step.j));
  }
  use_logarithm(joint.team.graph);
  return joint;
}

template <class Pose>
std::vector<Closure> closures_of(const TeamGraph<Pose>& team, const JointGraph<Pose>& joint) {
  const auto of_pose = robots_and_stamps(joint);
  std::vector<Closure> closures;
  for (std::size_t k = odometry_count(team); k < team.graph.relative_poses.size(); ++k) {
    const auto& factor = team.graph.relative_poses[k];
    const FactorOrigin &i = of_pose[factor.i.index()], &j = of_pose[factor.j.index()];
    Closure& closure = closures.emplace_back();
    closure.kind = ClosureKind::kFile;
    closure.robot_i = i.robot_i;
    closure.stamp_i = i.stamp_i;
    closure.robot_j = j.robot_i;
    closure.stamp_j = j.stamp_i;
    closure.T_i_j = as_se3(factor.T_i_j, 0);
    closure.information =
        information_in_space<Pose>(of_logarithm<Pose>(team.graph.chart, factor.information));
  }
  return closures;
}

template std::vector<Closure> closures_of(const TeamGraph<SE2>&, const JointGraph<SE2>&);
template std::vector<Closure> closures_of(const TeamGraph<SE3>&, const JointGraph<SE3>&);
template JointGraph<SE2> joint_graph_of(const TeamGraph<SE2>&, const Mission&);
template JointGraph<SE3> joint_graph_of(const TeamGraph<SE3>&, const Mission&);

}  // namespace radioslam

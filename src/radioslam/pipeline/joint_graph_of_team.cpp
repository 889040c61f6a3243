#include "radioslam/pipeline/joint_graph_of_team.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/pipeline/antenna_pairs.hpp"
#include "radioslam/team_frame/tied_team.hpp"

namespace radioslam {
namespace {

std::size_t robot_of(const Piece& piece, const Mission& mission) {
  const auto found = std::find_if(mission.robots.begin(), mission.robots.end(),
                                  [&](const Robot& robot) { return robot.id == piece.robot; });
  RADIOSLAM_CHECK(found != mission.robots.end(), "every piece belongs to a robot of the mission");
  return static_cast<std::size_t>(found - mission.robots.begin());
}

template <class Pose>
std::vector<RadioTie> robots_and_stamps(const JointGraph<Pose>& joint) {
  std::vector<RadioTie> of_pose(joint.team.graph.poses.size());
  for (std::size_t p = 0; p < joint.team.pieces.size(); ++p)
    for (std::size_t k = 0; k < joint.team.pieces[p].pose_count; ++k) {
      RadioTie& tie = of_pose[joint.team.pieces[p].first_pose + k];
      tie.robot_i = RobotIndex(joint.robot_of_piece[p]);
      tie.stamp_i = joint.team.pieces[p].stamps[k];
    }
  return of_pose;
}

}  // namespace

template <class Pose>
JointGraph<Pose> joint_graph_of(const TeamGraph<Pose>& team, const Mission& mission) {
  JointGraph<Pose> joint;
  joint.team = team;
  for (const Robot& robot : mission.robots) {
    JointRobot& added = joint.robots.emplace_back();
    added.id = robot.id;
    added.lidar_range_m = robot.lidar_range_m;
    added.lidar_view_rad = robot.lidar_view_rad;
  }
  for (const Piece& piece : team.pieces) {
    joint.robot_of_piece.push_back(robot_of(piece, mission));
    JointRobot& robot = joint.robots[joint.robot_of_piece.back()];
    for (std::size_t k = 0; k < piece.pose_count; ++k) {
      robot.stamps.push_back(piece.stamps[k]);
      robot.poses.push_back(PoseId(piece.first_pose + k));
      robot.odometry.push_back(as_se3(team.graph.poses[piece.first_pose + k], 0));
    }
  }
  const auto of_pose = robots_and_stamps(joint);
  const auto tie = [&](PoseId i, PoseId j) {
    RadioTie result;
    if (i.valid()) result.robot_i = of_pose[i.index()].robot_i, result.stamp_i = of_pose[i.index()].stamp_i;
    if (j.valid()) result.robot_j = of_pose[j.index()].robot_i, result.stamp_j = of_pose[j.index()].stamp_i;
    return result;
  };
  AntennaPairs pairs(joint.antenna_pairs);
  const auto name = [&](const RangeEnd<Pose>& end) {
    if (!end.pose.valid()) return "landmark " + std::to_string(end.point.index());
    return joint.robots[of_pose[end.pose.index()].robot_i.index()].id;
  };
  for (const auto& range : team.graph.ranges) {
    joint.range_ties.push_back(tie(range.i.pose, range.j.pose));
    joint.range_pairs.push_back(pairs.index_of(name(range.i), name(range.j)));
  }
  for (const auto& bearing : team.bearings) joint.bearing_ties.push_back(tie(bearing.i, bearing.j.pose));
  const auto piece_of = piece_of_poses(team);
  joint.ignored_links = static_cast<std::size_t>(
      std::count_if(team.graph.relative_poses.begin(), team.graph.relative_poses.end(),
                    [&](const auto& f) { return piece_of[f.i.index()] != piece_of[f.j.index()]; }));
  std::erase_if(joint.team.graph.relative_poses,
                [&](const auto& f) { return piece_of[f.i.index()] != piece_of[f.j.index()]; });
  joint.first_closure_range = team.graph.ranges.size();
  return joint;
}

template JointGraph<SE2> joint_graph_of(const TeamGraph<SE2>&, const Mission&);
template JointGraph<SE3> joint_graph_of(const TeamGraph<SE3>&, const Mission&);

}  // namespace radioslam

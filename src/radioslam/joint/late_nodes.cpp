#include "radioslam/joint/late_nodes.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/pose_ids.hpp"
#include "radioslam/joint/robot_nodes.hpp"

namespace radioslam {
namespace {

template <class Pose>
class NodeInsertion {
 public:
  NodeInsertion(TeamEstimate<Pose>& team, const Mission& mission, const JointGraphParams& params)
      : team_(team), joint_(team.joint), mission_(mission), params_(params) {}

  void insert(std::size_t segment, const std::vector<Stamp>& wanted) {
    TrajectorySegment& of = joint_.team.segments[segment];
    const std::size_t r = joint_.robot_of_segment[segment];
    const Robot& robot = mission_.robots[r];
    std::vector<Stamp> stamps = of.stamps;
    for (const Stamp stamp : wanted)
      if (of.stamps.front() < stamp && stamp < of.stamps.back()) stamps.push_back(stamp);
    const RobotNodes nodes = nodes_at(robot.odometry, std::move(stamps));
    if (nodes.stamps.size() == of.stamps.size()) return;

    insert_values(of, nodes, joint_.team.graph.poses);
    for (std::vector<Pose>& alternative : team_.alignment.alternatives) insert_values(of, nodes, alternative);
    renumber_poses(of, nodes);
    of.stamps = nodes.stamps;
    of.pose_count = nodes.stamps.size();
    divide_odometry(RobotIndex(r), nodes, of.first_pose);
  }

 private:
  /// A new pose follows the one before it by odometry.
  void insert_values(const TrajectorySegment& of, const RobotNodes& nodes, std::vector<Pose>& poses) const {
    std::vector<Pose> extended;
    std::size_t before = 0;
    for (std::size_t n = 0; n < nodes.stamps.size(); ++n) {
      const bool is_old = before < of.stamps.size() && of.stamps[before] == nodes.stamps[n];
      if (is_old) {
        extended.push_back(poses[of.first_pose + before++]);
      } else {
        const SE3 step =
            nodes.odometry[nodes.rows[n - 1]].pose.inverse() * nodes.odometry[nodes.rows[n]].pose;
        extended.push_back(extended.back() * pose_as<Pose>(step));
      }
    }
    const auto first = poses.begin() + static_cast<std::ptrdiff_t>(of.first_pose);
    const auto after = poses.erase(first, first + static_cast<std::ptrdiff_t>(of.pose_count));
    poses.insert(after, extended.begin(), extended.end());
  }

  void renumber_poses(const TrajectorySegment& of, const RobotNodes& nodes) {
    const std::size_t added = nodes.stamps.size() - of.stamps.size();
    const auto renumber = [&](PoseId& id) {
      if (id.index() < of.first_pose) return;
      const std::size_t k = id.index() - of.first_pose;
      id = PoseId(k < of.pose_count ? of.first_pose + nodes.node_at(of.stamps[k]) : id.index() + added);
    };
    for_each_pose_id(joint_.team.graph, renumber);
    for_each_pose_id(joint_.team.bearings, renumber);
    for (RobotFixes<Pose>& fixes : team_.judgement.fixes) for_each_pose_id(fixes.factors, renumber);
    for (RobotVariables& robot : joint_.robots)
      for (PoseId& id : robot.poses) visit_pose_id(id, renumber);
    for (TrajectorySegment& segment : joint_.team.segments)
      if (segment.first_pose > of.first_pose) segment.first_pose += added;
  }
  void divide_odometry(RobotIndex robot, const RobotNodes& nodes, std::size_t first_pose) {
    PoseGraph<Pose>& graph = joint_.team.graph;
    erase_relative_poses(joint_, [&](const FactorOrigin& origin) {
      return origin.source == FactorSource::kOdometry && origin.robot_i == robot;
    });
    add_odometry(joint_, robot, mission_.robots[robot.index()], nodes, first_pose,
                 joint_.robots[robot.index()].drift);
    std::erase_if(graph.pose_priors, [&](const PosePriorFactor<Pose>& prior) {
      return prior.gravity_only && first_pose <= prior.i.index() &&
             prior.i.index() < first_pose + nodes.stamps.size();
    });
    add_level_priors(graph, mission_.robots[robot.index()], nodes, first_pose, params_.sigma_level_rad);
  }

  TeamEstimate<Pose>& team_;
  JointGraph<Pose>& joint_;
  const Mission& mission_;
  const JointGraphParams& params_;
};

}  // namespace

template <class Pose>
void add_nodes(TeamEstimate<Pose>& team, const Mission& mission, const JointGraphParams& params,
               const std::vector<std::vector<Stamp>>& stamps) {
  RADIOSLAM_CHECK(team.joint.team.graph.pose_fixed.empty(), "no pose of a mission is held");
  NodeInsertion<Pose> insertion(team, mission, params);
  for (std::size_t p = 0; p < team.joint.team.segments.size(); ++p) {
    const std::size_t r = team.joint.robot_of_segment[p];
    if (mission.robots[r].odometry.empty() || stamps[r].empty()) continue;
    RADIOSLAM_CHECK(
        std::count(team.joint.robot_of_segment.begin(), team.joint.robot_of_segment.end(), r) == 1,
        "a robot of a mission has one segment");
    insertion.insert(p, stamps[r]);
  }
}

template void add_nodes(TeamEstimate<SE2>&, const Mission&, const JointGraphParams&,
                        const std::vector<std::vector<Stamp>>&);
template void add_nodes(TeamEstimate<SE3>&, const Mission&, const JointGraphParams&,
                        const std::vector<std::vector<Stamp>>&);

}  // namespace radioslam

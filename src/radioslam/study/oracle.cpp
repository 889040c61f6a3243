#include "radioslam/study/oracle.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {
namespace {

bool can_start_from(const Mission& mission, const Truth& truth) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const auto& odometry = mission.robots[r].odometry;
    const RobotTruth& known = truth.robots[r];
    if (!known.has_orientation || !known.poses.covers(odometry.front().stamp) ||
        !known.poses.covers(odometry.back().stamp))
      return false;
  }
  return std::all_of(mission.anchors.begin(), mission.anchors.end(),
                     [](const Anchor& anchor) { return anchor.position_m.has_value(); });
}

template <class Pose>
void start_from(const Truth& truth, JointGraph<Pose>& joint) {
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const TrajectorySegment& piece = joint.team.segments[p];
    const auto& poses = truth.robots[joint.robot_of_segment[p]].poses;
    for (std::size_t k = 0; k < piece.pose_count; ++k)
      joint.team.graph.poses[piece.first_pose + k] = pose_as<Pose>(*poses.at(piece.stamps[k]));
  }
}

template <class Pose>
void believe_every_link(JointGraph<Pose>& joint) {
  for (const auto& bearing : joint.team.bearings) {
    RADIOSLAM_CHECK(bearing.paths.size() == 1, "the oracle's measurements contain only their direct path");
    joint.team.graph.bearings.push_back(path_factor(bearing, 0));
  }
}

template <class Pose>
std::vector<EstimatedTrajectory> keyframe_poses(const JointGraph<Pose>& joint) {
  std::vector<EstimatedTrajectory> robots;
  for (const RobotVariables& robot : joint.robots) {
    std::vector<StampedPose<SE3>> poses;
    for (std::size_t k = 0; k < robot.poses.size(); ++k)
      poses.push_back({robot.stamps[k], as_se3(joint.team.graph.poses[robot.poses[k].index()],
                                               robot.odometry[k].translation().z())});
    robots.push_back({robot.id, Trajectory<SE3>(std::move(poses))});
  }
  return robots;
}

template <class Pose>
std::vector<EstimatedTrajectory> estimate(const Mission& labelled, const Truth& truth,
                                          const RunParams& params) {
  auto joint = build_joint_graph<Pose>(labelled, params.keyframe, params.graph);
  start_from(truth, joint);
  believe_every_link(joint);
  optimize(joint.team.graph, OptimizerParams{});
  return keyframe_poses(joint);
}

}  // namespace

Mission with_direct_paths_only(const Mission& mission, const Truth& truth) {
  Mission labelled = mission;
  labelled.aoa_measurements.clear();
  labelled.matches.clear();
  for (std::size_t k = 0; k < truth.direct_paths.size(); ++k) {
    const auto direct = truth.direct_paths[k];
    if (!direct || *direct == kNoDirectPath) continue;
    AoaMeasurement& kept = labelled.aoa_measurements.emplace_back(mission.aoa_measurements[k]);
    kept.paths = {mission.aoa_measurements[k].paths[static_cast<std::size_t>(*direct)]};
  }
  return labelled;
}

std::optional<std::vector<EstimatedTrajectory>> oracle_estimate(const Mission& mission, const Truth& truth,
                                                                const RunParams& params) {
  if (!can_start_from(mission, truth)) return std::nullopt;
  const Mission labelled = with_direct_paths_only(mission, truth);
  return mission.dimension == 2 ? estimate<SE2>(labelled, truth, params)
                                : estimate<SE3>(labelled, truth, params);
}

}  // namespace radioslam

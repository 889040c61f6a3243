#include "radioslam/study/oracle.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {
namespace {

using Trajectories = std::vector<const Trajectory<SE3>*>;

/// Whether the trajectories, one per robot, cover the odometry.
bool cover(const Trajectories& trajectories, const Mission& mission) {
  if (trajectories.size() != mission.robots.size()) return false;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const auto& odometry = mission.robots[r].odometry;
    if (!trajectories[r]->covers(odometry.front().stamp) || !trajectories[r]->covers(odometry.back().stamp))
      return false;
  }
  return true;
}

bool can_start_from(const Truth& truth, const Mission& mission) {
  if (!std::all_of(truth.robots.begin(), truth.robots.end(),
                   [](const RobotTruth& robot) { return robot.has_orientation; }))
    return false;
  return std::all_of(mission.anchors.begin(), mission.anchors.end(),
                     [](const Anchor& anchor) { return anchor.position_m.has_value(); });
}

template <class Pose>
void start_from(const Trajectories& trajectories, JointGraph<Pose>& joint) {
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const TrajectorySegment& piece = joint.team.segments[p];
    const Trajectory<SE3>& poses = *trajectories[joint.robot_of_segment[p]];
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

/// The likeliest estimate over the starts.
template <class Pose>
std::vector<EstimatedTrajectory> estimate(const Mission& labelled, const std::vector<Trajectories>& starts,
                                          const RunParams& params) {
  auto joint = build_joint_graph<Pose>(labelled, params.keyframe, params.graph);
  believe_every_link(joint);
  std::vector<EstimatedTrajectory> best;
  double least_cost = std::numeric_limits<double>::infinity();
  for (const Trajectories& start : starts) {
    JointGraph<Pose> from_start = joint;
    start_from(start, from_start);
    const double cost = optimize(from_start.team.graph, OptimizerParams{}).final_cost;
    if (!(cost < least_cost)) continue;
    least_cost = cost;
    best = keyframe_poses(from_start);
  }
  return best;
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

std::optional<std::vector<EstimatedTrajectory>> oracle_estimate(
    const Mission& mission, const Truth& truth, const RunParams& params,
    const std::vector<EstimatedTrajectory>& other_start) {
  if (!can_start_from(truth, mission)) return std::nullopt;
  std::vector<Trajectories> starts(2);
  for (const RobotTruth& robot : truth.robots) starts[0].push_back(&robot.poses);
  for (const EstimatedTrajectory& robot : other_start) starts[1].push_back(&robot.poses);
  if (!cover(starts[0], mission)) return std::nullopt;
  if (!cover(starts[1], mission)) starts.pop_back();
  const Mission labelled = with_direct_paths_only(mission, truth);
  return mission.dimension == 2 ? estimate<SE2>(labelled, starts, params)
                                : estimate<SE3>(labelled, starts, params);
}

}  // namespace radioslam

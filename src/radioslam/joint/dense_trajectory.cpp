#include "radioslam/joint/dense_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

namespace radioslam {
namespace {

/// The robot's only segment; null if gaps in its odometry split its trajectory.
template <class Pose>
const TrajectorySegment* only_segment(const JointGraph<Pose>& joint, std::size_t robot) {
  const auto& owners = joint.robot_of_segment;
  if (std::count(owners.begin(), owners.end(), robot) != 1) return nullptr;
  return &joint.team.segments[static_cast<std::size_t>(std::find(owners.begin(), owners.end(), robot) -
                                                       owners.begin())];
}

template <class Pose>
EstimatedKeyframes<Pose> estimated_poses(const JointGraph<Pose>& joint, const TrajectorySegment& segment,
                                         const Pose& T_frame_graph, const Marginals<Pose>* marginals) {
  std::vector<StampedPose<Pose>> poses;
  EstimatedKeyframes<Pose> keyframes;
  for (std::size_t k = 0; k < segment.pose_count; ++k) {
    const PoseId id(segment.first_pose + k);
    poses.push_back({segment.stamps[k], T_frame_graph * joint.team.graph.poses[id.index()]});
    if (marginals && k > 0)
      keyframes.covariances.push_back(
          marginals->joint(variable(PoseId(segment.first_pose + k - 1)), variable(id)));
  }
  keyframes.poses = Trajectory<Pose>(std::move(poses));
  return keyframes;
}

}  // namespace

template <class Pose>
std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(const Mission& mission,
                                                                const JointGraph<Pose>& joint,
                                                                const Marginals<Pose>* marginals,
                                                                std::size_t robot,
                                                                const RobotResult& estimate) {
  const TrajectorySegment* segment = only_segment(joint, robot);
  const Robot& recorded = mission.robots[robot];
  const RobotVariables& of = joint.robots[robot];
  if (!segment || of.poses.empty() || !recorded.odometry.covers(segment->stamps.front()) ||
      !recorded.odometry.covers(segment->stamps.back()))
    return std::nullopt;
  const Pose T_frame_graph = pose_as<Pose>(estimate.estimate.front().pose) *
                             joint.team.graph.poses[of.poses.front().index()].inverse();
  auto keyframes = estimated_poses(joint, *segment, T_frame_graph, marginals);
  if (of.drift.valid()) keyframes.drift = joint.team.graph.drifts[of.drift.index()];
  return ContinuousTrajectory<Pose>(recorded, std::move(keyframes));
}

template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate, const std::vector<Stamp>& stamps) {
  DenseTrajectory dense{estimate.id, {}, {}};
  const auto trajectory = continuous_trajectory(mission, joint, marginals, robot, estimate);
  if (!trajectory) return dense;
  std::vector<Stamp> covered;
  std::copy_if(stamps.begin(), stamps.end(), std::back_inserter(covered),
               [&](Stamp stamp) { return trajectory->covers(stamp); });
  const auto poses = trajectory->at(covered);
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const double z_m = mission.robots[robot].odometry.at(covered[k])->translation().z();
    rows.push_back({covered[k], as_se3(poses[k].pose, z_m)});
    if (marginals)
      dense.sigma_position_m.push_back(
          sigma_of(poses[k].covariance.template topLeftCorner<Pose::kDim, Pose::kDim>()));
  }
  dense.poses = Trajectory<SE3>(std::move(rows));
  return dense;
}

template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate) {
  return dense_trajectory(mission, joint, marginals, robot, estimate,
                          mission.robots[robot].odometry.stamps());
}

template <class Pose>
Trajectory<SE3> along_path(const Trajectory<SE3>& dense, const Trajectory<SE3>& path) {
  std::vector<StampedPose<SE3>> rows;
  auto next = path.begin();
  for (std::size_t k = 0; k < dense.size(); ++k) {
    if (k > 0) {
      const auto &a = dense[k - 1], &b = dense[k];
      const Pose T_frame_path = pose_as<Pose>(a.pose) * pose_as<Pose>(*path.at(a.stamp)).inverse();
      const auto missing =
          ((T_frame_path * pose_as<Pose>(*path.at(b.stamp))).inverse() * pose_as<Pose>(b.pose)).log().eval();
      for (; next != path.end() && next->stamp < b.stamp; ++next) {
        const double share = seconds_between(a.stamp, next->stamp) / seconds_between(a.stamp, b.stamp);
        rows.push_back(
            {next->stamp, as_se3(T_frame_path * pose_as<Pose>(next->pose) * Pose::exp(share * missing),
                                 next->pose.translation().z())});
      }
    }
    rows.push_back(dense[k]);
    while (next != path.end() && next->stamp <= dense[k].stamp) ++next;
  }
  return Trajectory<SE3>(std::move(rows));
}

#define RADIOSLAM_DENSE_TRAJECTORY(Pose)                                                                     \
  template std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(                                  \
      const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, std::size_t, const RobotResult&);     \
  template DenseTrajectory dense_trajectory(const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, \
                                            std::size_t, const RobotResult&, const std::vector<Stamp>&);     \
  template DenseTrajectory dense_trajectory(const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, \
                                            std::size_t, const RobotResult&);                                \
  template Trajectory<SE3> along_path<Pose>(const Trajectory<SE3>&, const Trajectory<SE3>&);
RADIOSLAM_DENSE_TRAJECTORY(SE2)
RADIOSLAM_DENSE_TRAJECTORY(SE3)
#undef RADIOSLAM_DENSE_TRAJECTORY

}  // namespace radioslam

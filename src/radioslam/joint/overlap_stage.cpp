#include "radioslam/joint/overlap_stage.hpp"

#include <utility>

#include "radioslam/joint/aoa/mutual_bearing_constraints.hpp"

namespace radioslam {
namespace {

template <class Source>
OverlapCounts search(const Source& source, const std::vector<OverlapSensor>& sensors,
                     const OverlapParams& params, SearchMethod method, const TakeOverlaps& take) {
  return method == SearchMethod::kTree ? search_overlaps(source, sensors, params, take)
                                       : search_overlaps_exhaustively(source, sensors, params, take);
}

/// All poses of each robot, and which of them are keyframes.
template <class Pose>
std::vector<ChainOfPoses> chains(const JointGraph<Pose>& joint) {
  std::vector<ChainOfPoses> result(joint.robots.size());
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const TrajectorySegment& segment = joint.team.segments[p];
    for (std::size_t k = 0; k < segment.pose_count; ++k)
      result[joint.robot_of_segment[p]].poses.push_back(PoseId(segment.first_pose + k));
  }
  for (std::size_t r = 0; r < result.size(); ++r) {
    std::size_t k = 0;
    for (const PoseId keyframe : joint.robots[r].poses) {
      while (result[r].poses[k] != keyframe) ++k;
      result[r].searched.push_back(k);
    }
  }
  return result;
}

template <class Pose>
CandidateList without_candidates(const JointGraph<Pose>& joint) {
  std::vector<std::vector<Stamp>> stamps;
  for (const RobotVariables& robot : joint.robots) stamps.push_back(robot.stamps);
  return CandidateList(std::move(stamps));
}

/// Candidates of one pair of robots.
CandidateList::Group group_of(const std::vector<OverlapCandidate>& found) {
  CandidateList::Group group;
  if (found.empty()) return group;
  group.robot_i = RobotIndex(static_cast<std::size_t>(found.front().robot_a));
  group.robot_j = RobotIndex(static_cast<std::size_t>(found.front().robot_b));
  group.rows.reserve(found.size());
  for (const OverlapCandidate& pair : found)
    group.rows.push_back({pair.pose_a, pair.pose_b, static_cast<float>(pair.distance_m),
                          static_cast<float>(pair.mahalanobis)});
  return group;
}

}  // namespace

void add_candidates(OverlapStage& stage, const OverlapStage& other) {
  if (!other.searched) return;
  stage.candidates.merge(other.candidates);
  stage.counts.kept = stage.candidates.size();
  stage.counts.distances_evaluated += other.counts.distances_evaluated;
  ++stage.alignments;
}

template <class Pose>
OverlapStage find_overlaps(const JointGraph<Pose>& joint, const OverlapStageParams& params,
                           SearchMethod method) {
  OverlapStage stage;
  stage.candidates = without_candidates(joint);
  const auto take = [&](const std::vector<OverlapCandidate>& found) {
    stage.candidates.append(group_of(found));
  };
  std::vector<OverlapSensor> sensors;
  for (const RobotVariables& robot : joint.robots)
    sensors.push_back({robot.lidar_range_m, robot.lidar_view_rad});
  if (overlap_mode(params) == OverlapMode::kLink) {
    stage.counts =
        search(measured_link_covariance(joint, params.pairing_s, static_cast<std::size_t>(params.max_links)),
               sensors, params.overlap, method, take);
  } else {
    const auto source = JointCovariance<Pose>::compute(joint.team.graph, chains(joint));
    if (!source) return stage;
    stage.counts = search(*source, sensors, params.overlap, method, take);
  }
  stage.searched = true;
  return stage;
}

template OverlapStage find_overlaps(const JointGraph<SE2>&, const OverlapStageParams&, SearchMethod);
template OverlapStage find_overlaps(const JointGraph<SE3>&, const OverlapStageParams&, SearchMethod);

}  // namespace radioslam

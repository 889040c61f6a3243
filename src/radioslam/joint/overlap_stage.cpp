#include "radioslam/joint/overlap_stage.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "radioslam/joint/aoa/mutual_bearing_constraints.hpp"

namespace radioslam {
namespace {

template <class Source>
OverlapCandidates search(const Source& source, const std::vector<OverlapSensor>& sensors,
                         const OverlapParams& params, SearchMethod method) {
  return method == SearchMethod::kTree ? search_overlaps(source, sensors, params)
                                       : search_overlaps_exhaustively(source, sensors, params);
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

CandidateResult candidate_result(const OverlapCandidate& found, const std::vector<Stamp>& stamps_a,
                                 const std::vector<Stamp>& stamps_b) {
  return {RobotIndex(static_cast<std::size_t>(found.robot_a)),
          stamps_a[found.pose_a],
          RobotIndex(static_cast<std::size_t>(found.robot_b)),
          stamps_b[found.pose_b],
          found.distance_m,
          found.mahalanobis};
}

}  // namespace

void add_candidates(OverlapStage& stage, const OverlapStage& other) {
  if (!other.searched) return;
  const auto pair = [](const CandidateResult& c) {
    return std::tuple(c.robot_i.value, c.robot_j.value, c.stamp_i, c.stamp_j);
  };
  stage.candidates.insert(stage.candidates.end(), other.candidates.begin(), other.candidates.end());
  std::stable_sort(stage.candidates.begin(), stage.candidates.end(), [&](const auto& x, const auto& y) {
    return std::pair(pair(x), x.mahalanobis) < std::pair(pair(y), y.mahalanobis);
  });
  const auto repeated = [&](const auto& x, const auto& y) { return pair(x) == pair(y); };
  stage.candidates.erase(std::unique(stage.candidates.begin(), stage.candidates.end(), repeated),
                         stage.candidates.end());
  stage.counts.kept = stage.candidates.size();
  stage.counts.distances_evaluated += other.counts.distances_evaluated;
  ++stage.alignments;
}

template <class Pose>
OverlapStage find_overlaps(const JointGraph<Pose>& joint, const OverlapStageParams& params,
                           SearchMethod method) {
  OverlapStage stage;
  std::vector<OverlapSensor> sensors;
  for (const RobotVariables& robot : joint.robots)
    sensors.push_back({robot.lidar_range_m, robot.lidar_view_rad});
  OverlapCandidates found;
  if (overlap_mode(params) == OverlapMode::kLink) {
    found =
        search(measured_link_covariance(joint, params.pairing_s, static_cast<std::size_t>(params.max_links)),
               sensors, params.overlap, method);
  } else {
    const auto source = JointCovariance<Pose>::compute(joint.team.graph, chains(joint));
    if (!source) return stage;
    found = search(*source, sensors, params.overlap, method);
  }
  stage.searched = true;
  stage.counts = found.counts;
  for (const OverlapCandidate& pair : found.candidates)
    stage.candidates.push_back(
        candidate_result(pair, joint.robots[pair.robot_a].stamps, joint.robots[pair.robot_b].stamps));
  return stage;
}

template OverlapStage find_overlaps(const JointGraph<SE2>&, const OverlapStageParams&, SearchMethod);
template OverlapStage find_overlaps(const JointGraph<SE3>&, const OverlapStageParams&, SearchMethod);

}  // namespace radioslam

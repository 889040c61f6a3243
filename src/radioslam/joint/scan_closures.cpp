#include "radioslam/joint/scan_closures.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/closure.hpp"

namespace radioslam {
namespace {

template <class Pose>
RelativePoseFactor<Pose> closure_factor(const JointGraph<Pose>& joint, const ScanClosure& closure) {
  RelativePoseFactor<Pose> factor;
  factor.i = pose_at(joint, closure.robot, closure.stamp_i);
  factor.j = pose_at(joint, closure.robot, closure.stamp_j);
  RADIOSLAM_CHECK(factor.i.valid() && factor.j.valid(), "a closure's stamps are nodes");
  factor.T_i_j = pose_as<Pose>(closure.loop.T_i_j);
  factor.information = information_as<Pose>(closure.loop.information);
  factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
  return factor;
}

/// Optimises every robot's trajectory by its own odometry and closures, without links between robots.
template <class Pose>
void apply_loop_closures(JointGraph<Pose>& joint, const OptimizerParams& optimizer) {
  PoseGraph<Pose> odometry_and_closures;
  odometry_and_closures.poses = joint.team.graph.poses;
  odometry_and_closures.drifts = joint.team.graph.drifts;
  odometry_and_closures.relative_poses = joint.team.graph.relative_poses;
  odometry_and_closures.drift_priors = joint.team.graph.drift_priors;
  for (RelativePoseFactor<Pose>& factor : odometry_and_closures.relative_poses)
    factor.loss.kind = LossKind::kNone;
  optimize(odometry_and_closures, optimizer);
  joint.team.graph.poses = std::move(odometry_and_closures.poses);
}

}  // namespace

void add_closure_stamps(const std::vector<ScanClosure>& closures,
                        std::vector<std::vector<Stamp>>& node_stamps) {
  for (const ScanClosure& closure : closures) {
    if (closure.loop.status != LoopStatus::kAccepted) continue;
    auto& of_robot = node_stamps[closure.robot.index()];
    of_robot.insert(of_robot.end(), {closure.stamp_i, closure.stamp_j});
  }
}

template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<ScanClosure>& closures,
                       const OptimizerParams& optimizer) {
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& [robot, stamp_i, stamp_j, loop] = closures[k];
    if (loop.status == LoopStatus::kAccepted)
      add_factor(joint, closure_factor(joint, closures[k]),
                 {FactorSource::kScanLoop, k, robot, robot, keyframe_stamp(joint, robot, stamp_i),
                  keyframe_stamp(joint, robot, stamp_j)});
  }
  if (!closures.empty()) apply_loop_closures(joint, optimizer);
}

template <class Pose>
std::vector<ClosureResult> collect_scan_closures(const JointGraph<Pose>& joint,
                                                 const std::vector<ScanClosure>& closures) {
  const auto factors =
      factors_by_measurement(joint.origins.relative_poses, FactorSource::kScanLoop, closures.size());
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& [robot, stamp_i, stamp_j, loop] = closures[k];
    ClosureResult result{robot,
                         keyframe_stamp(joint, robot, stamp_i),
                         robot,
                         keyframe_stamp(joint, robot, stamp_j),
                         ClosureKind::kLidar,
                         ClosureStatus::kRejected,
                         loop.inlier_ratio,
                         std::string(reason(loop.status))};
    if (factors[k]) {
      const auto& graph = joint.team.graph;
      result.statistic = squared_norm(graph, graph.relative_poses[*factors[k]]);
      if (result.statistic > kPoseChiSquared99<Pose>)
        result.reason = "the joint estimate disagrees";
      else
        result.status = ClosureStatus::kAccepted;
    }
    results.push_back(std::move(result));
  }
  return results;
}

#define RADIOSLAM_SCAN_CLOSURES(Pose)                                                 \
  template void add_scan_closures(JointGraph<Pose>&, const std::vector<ScanClosure>&, \
                                  const OptimizerParams&);                            \
  template std::vector<ClosureResult> collect_scan_closures(const JointGraph<Pose>&,  \
                                                            const std::vector<ScanClosure>&);
RADIOSLAM_SCAN_CLOSURES(SE2)
RADIOSLAM_SCAN_CLOSURES(SE3)
#undef RADIOSLAM_SCAN_CLOSURES

}  // namespace radioslam

#include "radioslam/joint/scan_closures.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace radioslam {
namespace {

/// Optimizes every robot's trajectory by its own odometry and closures, without links between robots.
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

std::vector<Closure> closures_of_scans(const std::vector<ScanClosure>& scans) {
  std::vector<Closure> closures;
  for (const auto& [robot, stamp_i, stamp_j, loop] : scans) {
    Closure& closure = closures.emplace_back();
    closure.kind = ClosureKind::kLidar;
    closure.robot_i = closure.robot_j = robot;
    closure.stamp_i = stamp_i;
    closure.stamp_j = stamp_j;
    closure.T_i_j = loop.T_i_j;
    closure.information = loop.information;
    closure.statistic = loop.inlier_ratio;
    if (loop.status != LoopStatus::kAccepted) reject(closure, std::string(reason(loop.status)));
  }
  return closures;
}

void add_closure_stamps(const std::vector<Closure>& closures, std::vector<std::vector<Stamp>>& node_stamps) {
  for (const Closure& closure : closures) {
    if (closure.status != ClosureStatus::kAccepted) continue;
    node_stamps[closure.robot_i.index()].push_back(closure.stamp_i);
    node_stamps[closure.robot_j.index()].push_back(closure.stamp_j);
  }
}

template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                       const OptimizerParams& optimizer) {
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (closures[k].status != ClosureStatus::kAccepted) continue;
    RelativePoseFactor<Pose> factor = closure_factor(joint, closures[k]);
    factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
    add_closure(joint, closures[k], std::move(factor), FactorSource::kScanLoop, k);
  }
  if (!closures.empty()) apply_loop_closures(joint, optimizer);
}

template void add_scan_closures(JointGraph<SE2>&, const std::vector<Closure>&, const OptimizerParams&);
template void add_scan_closures(JointGraph<SE3>&, const std::vector<Closure>&, const OptimizerParams&);

}  // namespace radioslam

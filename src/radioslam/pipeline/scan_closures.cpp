#include "radioslam/pipeline/scan_closures.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// As the estimate's dimension sees it: height, roll and pitch taken as free.
template <class Pose>
typename Pose::Jacobian information_as(const SE3::Jacobian& information) {
  if constexpr (Pose::kDim == 3) {
    return information;
  } else {
    const std::array<int, 3> kept{0, 1, 5}, freed{2, 3, 4};
    constexpr double kLeast = 1e-9;
    const Eigen::Matrix3d of_freed = information(freed, freed) + kLeast * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d cross = information(kept, freed);
    return information(kept, kept) - cross * of_freed.inverse() * cross.transpose();
  }
}

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

/// The robots' ways alone, without what ties robots to each other.
template <class Pose>
void straighten(JointGraph<Pose>& joint, const OptimizerParams& optimizer) {
  PoseGraph<Pose> ways;
  ways.poses = joint.team.graph.poses;
  ways.drifts = joint.team.graph.drifts;
  ways.relative_poses = joint.team.graph.relative_poses;
  ways.drift_priors = joint.team.graph.drift_priors;
  for (RelativePoseFactor<Pose>& factor : ways.relative_poses) factor.loss.kind = LossKind::kNone;
  optimize(ways, optimizer);
  joint.team.graph.poses = std::move(ways.poses);
}

}  // namespace

void add_closure_moments(const std::vector<ScanClosure>& closures, std::vector<std::vector<Stamp>>& moments) {
  for (const ScanClosure& closure : closures) {
    if (closure.loop.verdict != LoopVerdict::kAccepted) continue;
    auto& of_robot = moments[closure.robot.index()];
    of_robot.insert(of_robot.end(), {closure.stamp_i, closure.stamp_j});
  }
}

template <class Pose>
ScanTies add_scan_closures(JointGraph<Pose>& joint, const std::vector<ScanClosure>& closures,
                           const OptimizerParams& optimizer) {
  ScanTies ties(closures.size(), -1);
  auto& factors = joint.team.graph.relative_poses;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (closures[k].loop.verdict != LoopVerdict::kAccepted) continue;
    ties[k] = static_cast<std::ptrdiff_t>(factors.size());
    factors.push_back(closure_factor(joint, closures[k]));
  }
  if (!closures.empty()) straighten(joint, optimizer);
  return ties;
}

template <class Pose>
std::vector<ClosureResult> collect_scan_closures(const JointGraph<Pose>& joint,
                                                 const std::vector<ScanClosure>& closures,
                                                 const ScanTies& ties) {
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& [robot, stamp_i, stamp_j, loop] = closures[k];
    const auto& keyframes = joint.robots[robot.index()].stamps;
    ClosureResult result{robot,
                         keyframes[keyframe_before(keyframes, stamp_i)],
                         robot,
                         keyframes[keyframe_before(keyframes, stamp_j)],
                         ClosureKind::kLidar,
                         ClosureStatus::kRejected,
                         loop.matched_share,
                         std::string(reason(loop.verdict))};
    if (ties[k] >= 0) {
      const auto& graph = joint.team.graph;
      result.statistic = squared_norm(graph, graph.relative_poses[static_cast<std::size_t>(ties[k])]);
      if (result.statistic > kPoseChiSquared99<Pose>)
        result.reason = "the joint estimate disagrees";
      else
        result.status = ClosureStatus::kAccepted;
    }
    results.push_back(std::move(result));
  }
  return results;
}

#define RADIOSLAM_SCAN_CLOSURES(Pose)                                                     \
  template ScanTies add_scan_closures(JointGraph<Pose>&, const std::vector<ScanClosure>&, \
                                      const OptimizerParams&);                            \
  template std::vector<ClosureResult> collect_scan_closures(                              \
      const JointGraph<Pose>&, const std::vector<ScanClosure>&, const ScanTies&);
RADIOSLAM_SCAN_CLOSURES(SE2)
RADIOSLAM_SCAN_CLOSURES(SE3)
#undef RADIOSLAM_SCAN_CLOSURES

}  // namespace radioslam

#include "radioslam/joint/closures/closure.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/keyframe_poses.hpp"

namespace radioslam {

template <class Pose>
typename Pose::Jacobian information_as(const SE3::Jacobian& information) {
  if constexpr (Pose::kDim == 3) {
    return information;
  } else {
    const std::array<int, 3> kept{0, 1, 5}, freed{2, 3, 4};
    constexpr double kMin = 1e-9;
    const Eigen::Matrix3d of_freed = information(freed, freed) + kMin * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d cross = information(kept, freed);
    return information(kept, kept) - cross * of_freed.inverse() * cross.transpose();
  }
}

template <class Pose>
SE3::Jacobian information_in_space(const typename Pose::Jacobian& information) {
  if constexpr (Pose::kDim == 3) {
    return information;
  } else {
    SE3::Jacobian result = SE3::Jacobian::Identity();
    const std::array<int, 3> kept{0, 1, 5};
    result(kept, kept) = information;
    return result;
  }
}

template <class Pose>
typename Pose::Jacobian covariance_of(const Closure& closure) {
  return inverse(information_as<Pose>(closure.information));
}

template <class Pose>
ClosureEnds closure_ends(const JointGraph<Pose>& joint, const Closure& closure) {
  return {pose_at(joint, closure.robot_i, closure.stamp_i), pose_at(joint, closure.robot_j, closure.stamp_j)};
}

void append(const std::vector<VerifiedClosure>& verified, std::vector<Closure>& closures,
            std::vector<ClosureJudgement>& judgements) {
  for (const auto& [closure, judgement] : verified) {
    closures.push_back(closure);
    judgements.push_back(judgement);
  }
}

void reject(ClosureJudgement& judgement, std::string reason) {
  judgement.status = ClosureStatus::kRejected;
  judgement.reason = std::move(reason);
}

std::vector<Closure> closures_of_matches(const Mission& mission) {
  std::vector<Closure> closures;
  for (const PoseMatch& match : mission.matches) {
    Closure& closure = closures.emplace_back();
    closure.kind = ClosureKind::kMatch;
    closure.robot_i = match.robot_i;
    closure.robot_j = match.robot_j;
    closure.stamp_i = match.stamp_i;
    closure.stamp_j = match.stamp_j;
    closure.T_i_j = match.T_i_j;
    const SE3::Jacobian information = inverse(match.covariance);
    closure.information = (information + information.transpose()) / 2;
  }
  return closures;
}

namespace {

UncertainPose<SE3> in_space(const UncertainPose<SE2>& of) {
  UncertainPose<SE3> result{lift(of.pose)};
  const std::array<int, 3> kept{0, 1, 5};
  result.covariance(kept, kept) = of.covariance;
  return result;
}
UncertainPose<SE3> in_space(const UncertainPose<SE3>& of) { return of; }

}  // namespace

template <class Pose>
void hang_on_keyframes(const JointGraph<Pose>& joint, const Mission& mission,
                       std::vector<Closure>& closures) {
  KeyframePoses<Pose> poses(joint, mission);
  for (Closure& closure : closures) {
    if (closure_ends(joint, closure).valid()) continue;
    const auto i = poses.at(closure.robot_i, closure.stamp_i), j = poses.at(closure.robot_j, closure.stamp_j);
    if (!i || !j) continue;
    const UncertainPose<SE3> T_i_j{closure.T_i_j, inverse(closure.information)};
    const auto moved =
        in_space(i->motion.T_keyframe_body) * T_i_j * in_space(j->motion.T_keyframe_body).inverse();
    closure.stamp_i = i->keyframe;
    closure.stamp_j = j->keyframe;
    closure.T_i_j = moved.pose;
    const SE3::Jacobian information = inverse(moved.covariance);
    closure.information = (information + information.transpose()) / 2;
  }
}

template <class Pose>
RelativePoseFactor<Pose> closure_factor(const JointGraph<Pose>& joint, const Closure& closure) {
  const ClosureEnds ends = closure_ends(joint, closure);
  RADIOSLAM_CHECK(ends.valid(), "both ends of a closure are poses");
  RelativePoseFactor<Pose> factor;
  factor.i = ends.i;
  factor.j = ends.j;
  factor.T_i_j = pose_as<Pose>(closure.T_i_j);
  factor.information = information_as<Pose>(closure.information);
  return factor;
}

template <class Pose>
void add_closure(JointGraph<Pose>& joint, const Closure& closure, RelativePoseFactor<Pose> factor,
                 FactorSource source, std::size_t index) {
  add_factor(joint, std::move(factor),
             {source, index, closure.robot_i, closure.robot_j,
              keyframe_stamp(joint, closure.robot_i, closure.stamp_i),
              keyframe_stamp(joint, closure.robot_j, closure.stamp_j)});
}

template <class Pose>
void test_closures(const JointGraph<Pose>& joint, FactorSource source,
                   std::vector<ClosureJudgement>& judgements) {
  const auto& factors = joint.team.graph.relative_poses;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const FactorOrigin& origin = joint.origins.relative_poses[k];
    if (origin.source != source) continue;
    ClosureJudgement& judgement = judgements[origin.measurement];
    judgement = {ClosureStatus::kAccepted, squared_norm(joint.team.graph, factors[k]), {}};
    if (judgement.statistic > kPoseChiSquared99<Pose>) reject(judgement, "the joint estimate disagrees");
  }
}

namespace {

/// The pose of the keyframe before `stamp` in the frame of the pose there.
template <class Pose>
SE3 to_keyframe(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp, PoseId at) {
  const auto& poses = joint.team.graph.poses;
  const RobotVariables& of = joint.robots[robot.index()];
  const PoseId keyframe = of.poses[keyframe_before(of.stamps, stamp)];
  return as_se3(Pose(poses[at.index()].inverse() * poses[keyframe.index()]), 0);
}

}  // namespace

template <class Pose>
std::vector<ClosureResult> collect_closures(const JointGraph<Pose>& joint,
                                            const std::vector<Closure>& closures,
                                            const std::vector<ClosureJudgement>& judgements) {
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Closure& closure = closures[k];
    ClosureResult& result = results.emplace_back();
    result.robot_i = closure.robot_i;
    result.stamp_i = keyframe_stamp(joint, closure.robot_i, closure.stamp_i);
    result.robot_j = closure.robot_j;
    result.stamp_j = keyframe_stamp(joint, closure.robot_j, closure.stamp_j);
    result.kind = closure.kind;
    result.status = judgements[k].status;
    result.statistic = judgements[k].statistic;
    result.reason = judgements[k].reason;
    result.doubt = judgements[k].doubt;
    if (const auto [i, j] = closure_ends(joint, closure); i.valid() && j.valid())
      result.T_i_j = to_keyframe(joint, closure.robot_i, closure.stamp_i, i).inverse() * closure.T_i_j *
                     to_keyframe(joint, closure.robot_j, closure.stamp_j, j);
  }
  return results;
}

#define RADIOSLAM_CLOSURE(Pose)                                                                              \
  template Pose::Jacobian information_as<Pose>(const SE3::Jacobian&);                                        \
  template SE3::Jacobian information_in_space<Pose>(const Pose::Jacobian&);                                  \
  template Pose::Jacobian covariance_of<Pose>(const Closure&);                                               \
  template ClosureEnds closure_ends(const JointGraph<Pose>&, const Closure&);                                \
  template void hang_on_keyframes(const JointGraph<Pose>&, const Mission&, std::vector<Closure>&);           \
  template RelativePoseFactor<Pose> closure_factor(const JointGraph<Pose>&, const Closure&);                 \
  template void add_closure(JointGraph<Pose>&, const Closure&, RelativePoseFactor<Pose>, FactorSource,       \
                            std::size_t);                                                                    \
  template void test_closures(const JointGraph<Pose>&, FactorSource, std::vector<ClosureJudgement>&);        \
  template std::vector<ClosureResult> collect_closures(const JointGraph<Pose>&, const std::vector<Closure>&, \
                                                       const std::vector<ClosureJudgement>&);
RADIOSLAM_CLOSURE(SE2)
RADIOSLAM_CLOSURE(SE3)
#undef RADIOSLAM_CLOSURE

VerifiedClosure closure_of_scan(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j, Stamp stamp_j,
                                const ScanLoop& loop) {
  VerifiedClosure verified;
  auto& [closure, judgement] = verified;
  closure.kind = ClosureKind::kLidar;
  closure.robot_i = robot_i;
  closure.robot_j = robot_j;
  closure.stamp_i = stamp_i;
  closure.stamp_j = stamp_j;
  closure.T_i_j = loop.T_i_j;
  closure.information = loop.information;
  judgement.statistic = loop.inlier_ratio;
  judgement.doubt = loop.doubt;
  if (loop.status != LoopStatus::kAccepted) reject(judgement, std::string(reason(loop.status)));
  return verified;
}

std::vector<VerifiedClosure> closures_of_scans(const std::vector<ScanClosure>& scans) {
  std::vector<VerifiedClosure> closures;
  for (const auto& [robot, stamp_i, stamp_j, loop] : scans)
    closures.push_back(closure_of_scan(robot, stamp_i, robot, stamp_j, loop));
  return closures;
}

template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<VerifiedClosure>& closures) {
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& [closure, judgement] = closures[k];
    if (judgement.status != ClosureStatus::kAccepted) continue;
    RelativePoseFactor<Pose> factor = closure_factor(joint, closure);
    factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
    add_closure(joint, closure, std::move(factor), FactorSource::kScanLoop, k);
  }
}

template <class Pose>
void correct_by_scans(JointGraph<Pose>& joint, const Mission& mission, const MeasuredScans& scans) {
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s) {
    const std::size_t r = joint.robot_of_segment[s];
    if (r >= scans.robots.size() || !scans.robots[r] || scans.robots[r]->corrected.empty()) continue;
    const ScanOdometry& scanned = *scans.robots[r];
    const Trajectory<SE3>& odometry = mission.robots[r].odometry;
    const auto at = [&](Stamp stamp) { return odometry.at(stamp).value_or(SE3()); };
    const SE3 T_frame_first = joint.robots[r].T_common_start.value_or(SE3()) *
                              at(scanned.keyframe_stamps.front()) * scanned.corrected.front().inverse();
    const TrajectorySegment& segment = joint.team.segments[s];
    for (std::size_t n = 0; n < segment.pose_count; ++n) {
      const std::size_t k = keyframe_before(scanned.keyframe_stamps, segment.stamps[n]);
      const SE3 T_keyframe_node = at(scanned.keyframe_stamps[k]).inverse() * at(segment.stamps[n]);
      joint.team.graph.poses[segment.first_pose + n] =
          pose_as<Pose>(T_frame_first * scanned.corrected[k] * T_keyframe_node);
    }
  }
}

template void add_scan_closures(JointGraph<SE2>&, const std::vector<VerifiedClosure>&);
template void add_scan_closures(JointGraph<SE3>&, const std::vector<VerifiedClosure>&);
template void correct_by_scans(JointGraph<SE2>&, const Mission&, const MeasuredScans&);
template void correct_by_scans(JointGraph<SE3>&, const Mission&, const MeasuredScans&);

}  // namespace radioslam

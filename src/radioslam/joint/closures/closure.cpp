#include "radioslam/joint/closures/closure.hpp"

#include <Eigen/LU>
#include <array>
#include <utility>

#include "radioslam/joint/matches/match_groups.hpp"

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
ClosureEnds closure_ends(const JointGraph<Pose>& joint, const Closure& closure) {
  return {pose_at(joint, closure.robot_i, closure.stamp_i), pose_at(joint, closure.robot_j, closure.stamp_j)};
}

void reject(Closure& closure, std::string reason) {
  closure.status = ClosureStatus::kRejected;
  closure.reason = std::move(reason);
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
    closure.information = match_information<SE3>(match);
  }
  return closures;
}

template <class Pose>
std::vector<ClosureResult> collect_closures(const JointGraph<Pose>& joint,
                                            const std::vector<Closure>& closures) {
  std::vector<ClosureResult> results;
  for (const Closure& closure : closures) {
    ClosureResult& result = results.emplace_back();
    result.robot_i = closure.robot_i;
    result.stamp_i = keyframe_stamp(joint, closure.robot_i, closure.stamp_i);
    result.robot_j = closure.robot_j;
    result.stamp_j = keyframe_stamp(joint, closure.robot_j, closure.stamp_j);
    result.kind = closure.kind;
    result.status = closure.status;
    result.statistic = closure.statistic;
    result.reason = closure.reason;
  }
  return results;
}

template SE2::Jacobian information_as<SE2>(const SE3::Jacobian&);
template SE3::Jacobian information_as<SE3>(const SE3::Jacobian&);
template ClosureEnds closure_ends(const JointGraph<SE2>&, const Closure&);
template ClosureEnds closure_ends(const JointGraph<SE3>&, const Closure&);
template std::vector<ClosureResult> collect_closures(const JointGraph<SE2>&, const std::vector<Closure>&);
template std::vector<ClosureResult> collect_closures(const JointGraph<SE3>&, const std::vector<Closure>&);

}  // namespace radioslam

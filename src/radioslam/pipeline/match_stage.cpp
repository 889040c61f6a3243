#include "radioslam/pipeline/match_stage.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// chi-squared, 99 %: 3 and 6 degrees of freedom.
template <class Pose>
constexpr double kConsistent = Pose::kDof == 3 ? 11.345 : 16.812;

using CandidateKey = std::tuple<RobotIndex, Stamp, RobotIndex, Stamp>;

std::set<CandidateKey> keys(const std::vector<CandidateResult>& candidates) {
  std::set<CandidateKey> result;
  for (const auto& c : candidates) {
    result.insert({c.robot_i, c.stamp_i, c.robot_j, c.stamp_j});
    result.insert({c.robot_j, c.stamp_j, c.robot_i, c.stamp_i});
  }
  return result;
}

template <class Pose>
typename Pose::Jacobian match_information(const PoseMatch& match) {
  constexpr int kRotations = Pose::kDof - Pose::kDim;
  typename Pose::Tangent diagonal = Pose::Tangent::Constant(1 / (match.sigma_t_m * match.sigma_t_m));
  diagonal.template tail<kRotations>().setConstant(1 / (match.sigma_r_rad * match.sigma_r_rad));
  return diagonal.asDiagonal();
}

/// The pose of a robot at exactly this stamp, which select_nodes made; nothing outside its odometry.
template <class Pose>
PoseId pose_at(const JointGraph<Pose>& joint, RobotIndex robot, Stamp stamp) {
  for (std::size_t p = 0; p < joint.team.pieces.size(); ++p) {
    if (joint.robot_of_piece[p] != robot.index()) continue;
    const Piece& piece = joint.team.pieces[p];
    const auto found = std::lower_bound(piece.stamps.begin(), piece.stamps.end(), stamp);
    if (found != piece.stamps.end() && *found == stamp)
      return PoseId(piece.first_pose + static_cast<std::size_t>(found - piece.stamps.begin()));
  }
  return {};
}

MatchVerdict reject(MatchVerdict verdict, std::string reason) {
  verdict.status = ClosureStatus::kRejected;
  verdict.reason = std::move(reason);
  return verdict;
}

template <class Pose>
MatchVerdict judge(JointGraph<Pose>& joint, const PoseMatch& match, const std::set<CandidateKey>& candidates,
                   Pruning pruning) {
  MatchVerdict verdict;
  const PoseId i = pose_at(joint, match.robot_i, match.stamp_i);
  const PoseId j = pose_at(joint, match.robot_j, match.stamp_j);
  const auto keyframe = [&](RobotIndex robot, Stamp stamp) {
    const auto& stamps = joint.robots[robot.index()].stamps;
    return stamps[keyframe_before(stamps, stamp)];
  };
  verdict.tie = {match.robot_i, match.robot_j, keyframe(match.robot_i, match.stamp_i),
                 keyframe(match.robot_j, match.stamp_j)};
  if (!i.valid() || !j.valid()) return reject(verdict, "no odometry at its time");
  const auto& tie = verdict.tie;
  if (pruning == Pruning::kOn && tie.robot_i != tie.robot_j &&
      !candidates.contains({tie.robot_i, tie.stamp_i, tie.robot_j, tie.stamp_j}))
    return reject(verdict, "the views cannot overlap");
  RelativePoseFactor<Pose> factor;
  factor.i = i;
  factor.j = j;
  factor.T_i_j = pose_as<Pose>(match.T_i_j);
  factor.information = match_information<Pose>(match);
  factor.loss = {LossKind::kGemanMcClure, std::sqrt(kConsistent<Pose>)};
  verdict.factor = static_cast<std::ptrdiff_t>(joint.team.graph.relative_poses.size());
  joint.team.graph.relative_poses.push_back(factor);
  return verdict;
}

}  // namespace

template <class Pose>
std::vector<MatchVerdict> admit_matches(JointGraph<Pose>& joint, const Mission& mission,
                                        const std::vector<CandidateResult>& candidates, Pruning pruning) {
  const auto pairs = keys(candidates);
  std::vector<MatchVerdict> verdicts;
  for (const PoseMatch& match : mission.matches) verdicts.push_back(judge(joint, match, pairs, pruning));
  return verdicts;
}

template <class Pose>
void settle_matches(JointGraph<Pose>& joint, std::vector<MatchVerdict>& verdicts,
                    const OptimizerParams& optimizer, const Progress& progress) {
  auto& graph = joint.team.graph;
  FactorMask mask;
  mask.relative_poses.assign(graph.relative_poses.size(), false);
  for (const MatchVerdict& verdict : verdicts)
    if (verdict.factor >= 0) mask.relative_poses[static_cast<std::size_t>(verdict.factor)] = true;
  const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares,
                                          GraduatedParams{}, optimizer, progress);
  apply_weights(summary.weights, mask, graph);
  constexpr double kHalf = 0.5;
  for (MatchVerdict& verdict : verdicts) {
    if (verdict.factor < 0) continue;
    const auto& factor = graph.relative_poses[static_cast<std::size_t>(verdict.factor)];
    verdict.statistic = squared_norm(graph, factor);
    if (factor.weight < kHalf) verdict = reject(verdict, "the joint estimate disagrees");
  }
}

#define RADIOSLAM_MATCH_STAGE(Pose)                                                                   \
  template std::vector<MatchVerdict> admit_matches(JointGraph<Pose>&, const Mission&,                 \
                                                   const std::vector<CandidateResult>&, Pruning);     \
  template void settle_matches(JointGraph<Pose>&, std::vector<MatchVerdict>&, const OptimizerParams&, \
                               const Progress&);
RADIOSLAM_MATCH_STAGE(SE2)
RADIOSLAM_MATCH_STAGE(SE3)
#undef RADIOSLAM_MATCH_STAGE

}  // namespace radioslam

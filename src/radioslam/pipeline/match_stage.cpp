#include "radioslam/pipeline/match_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/consistency/consistent_set.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

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

MatchVerdict reject(MatchVerdict verdict, std::string reason) {
  verdict.status = ClosureStatus::kRejected;
  verdict.reason = std::move(reason);
  return verdict;
}

constexpr double kLeastShare = 0.5;  // of its information, below which a match counts as rejected

/// A match that nothing speaks against yet.
struct Admitted {
  std::size_t index = 0;  ///< in the mission
  PoseId i, j;
};

template <class Pose>
class Admission {
 public:
  Admission(JointGraph<Pose>& joint, const Mission& mission, const std::vector<CandidateResult>& candidates,
            Pruning pruning, const MatchParams& params, const ArrivalLikelihoodParams& likelihood)
      : joint_(joint), mission_(mission), candidates_(keys(candidates)), pruning_(pruning), params_(params) {
    if (params.angle_weights) angles_.emplace(mission, params, likelihood);
    for (std::size_t m = 0; m < mission.matches.size(); ++m) verdicts_.push_back(judge(m));
  }

  std::vector<MatchVerdict> run() {
    if (params_.robust)
      for (const auto& [robots, matches] : between_robots_) keep_consistent(matches);
    for (const Admitted& match : admitted_)
      if (verdicts_[match.index].status == ClosureStatus::kAccepted) add_factor(match);
    return std::move(verdicts_);
  }

 private:
  MatchVerdict judge(std::size_t index) {
    const PoseMatch& match = mission_.matches[index];
    const auto keyframe = [&](RobotIndex robot, Stamp stamp) {
      const auto& stamps = joint_.robots[robot.index()].stamps;
      return stamps[keyframe_before(stamps, stamp)];
    };
    MatchVerdict verdict;
    const RadioTie& tie = verdict.tie = {match.robot_i, match.robot_j, keyframe(match.robot_i, match.stamp_i),
                                         keyframe(match.robot_j, match.stamp_j)};
    const PoseId i = pose_at(joint_, match.robot_i, match.stamp_i);
    const PoseId j = pose_at(joint_, match.robot_j, match.stamp_j);
    if (!i.valid() || !j.valid()) return reject(verdict, "no odometry at its time");
    const bool other = match.robot_i != match.robot_j;
    if (other && pruning_ == Pruning::kOn &&
        !candidates_.contains({tie.robot_i, tie.stamp_i, tie.robot_j, tie.stamp_j}))
      return reject(verdict, "the views cannot overlap");
    if (other) between_robots_[std::minmax(match.robot_i, match.robot_j)].push_back(admitted_.size());
    admitted_.push_back({index, i, j});
    return verdict;
  }

  /// Rejects all but the largest consistent set of the matches of one pair of robots.
  void keep_consistent(const std::vector<std::size_t>& group) {
    const PoseMatch& first = mission_.matches[admitted_[group.front()].index];
    const auto [a, b] = std::minmax(first.robot_i, first.robot_j);
    std::vector<RelativePoseMatch<Pose>> matches;
    for (const std::size_t k : group) matches.push_back(oriented(admitted_[k], a));
    const ConsistentSet set = largest_consistent_set(chain(a), chain(b), matches);
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (set.matches[k].is_in) continue;
      MatchVerdict& verdict = verdicts_[admitted_[group[k]].index];
      verdict.statistic = set.matches[k].best_statistic.value_or(0);
      verdict = reject(verdict, "not consistent with the largest set of matches");
    }
  }

  RelativePoseMatch<Pose> oriented(const Admitted& match, RobotIndex a) const {
    const PoseMatch& measured = mission_.matches[match.index];
    const Pose T_i_j = pose_as<Pose>(measured.T_i_j);
    const typename Pose::Jacobian covariance = match_information<Pose>(measured).inverse();
    const auto place = [&](PoseId id, RobotIndex robot) { return id.index() - piece(robot).first_pose; };
    if (measured.robot_i == a)
      return {place(match.i, measured.robot_i), place(match.j, measured.robot_j), T_i_j, covariance};
    const typename Pose::Jacobian turn = T_i_j.adjoint();
    return {place(match.j, measured.robot_j), place(match.i, measured.robot_i), T_i_j.inverse(),
            turn * covariance * turn.transpose()};
  }

  /// A mission's robots have one piece each.
  const Piece& piece(RobotIndex robot) const { return joint_.team.pieces[robot.index()]; }

  OdometryChain<Pose> chain(RobotIndex robot) const {
    const Piece& of = piece(robot);
    std::vector<Pose> poses{Pose()};
    std::vector<typename Pose::Jacobian> steps;
    for (const auto& factor : joint_.team.graph.relative_poses) {
      const bool mine =
          factor.i.index() == of.first_pose + poses.size() - 1 && factor.j.value == factor.i.value + 1;
      if (!mine || poses.size() == of.pose_count) continue;
      poses.push_back(poses.back() * factor.T_i_j);
      steps.push_back(factor.information.inverse());
    }
    return {std::move(poses), steps};
  }

  void add_factor(const Admitted& match) {
    const PoseMatch& measured = mission_.matches[match.index];
    RelativePoseFactor<Pose> factor;
    factor.i = match.i;
    factor.j = match.j;
    factor.T_i_j = pose_as<Pose>(measured.T_i_j);
    factor.information = match_information<Pose>(measured);
    if (params_.robust) factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
    MatchVerdict& verdict = verdicts_[match.index];
    if (angles_ && measured.robot_i != measured.robot_j)
      verdict.angle_scale = angles_->template information_scale<Pose>(measured);
    if (verdict.angle_scale.value_or(1) < kLeastShare) {
      verdict = reject(verdict, "the angles of arrival disagree");
      return;
    }
    factor.information *= verdict.angle_scale.value_or(1);
    verdict.factor = static_cast<std::ptrdiff_t>(joint_.team.graph.relative_poses.size());
    joint_.team.graph.relative_poses.push_back(factor);
  }

  JointGraph<Pose>& joint_;
  const Mission& mission_;
  std::set<CandidateKey> candidates_;
  Pruning pruning_;
  MatchParams params_;
  std::optional<MatchAngles> angles_;  ///< only where they are to weigh
  std::vector<Admitted> admitted_;
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<std::size_t>> between_robots_;  ///< in admitted_
  std::vector<MatchVerdict> verdicts_;
};

/// With a loss that gives up on what does not fit.
template <class Pose>
void optimize_graduated_matches(JointGraph<Pose>& joint, const std::vector<MatchVerdict>& verdicts,
                                const OptimizerParams& optimizer, const Progress& progress) {
  auto& graph = joint.team.graph;
  FactorMask mask;
  mask.relative_poses.assign(graph.relative_poses.size(), false);
  for (const MatchVerdict& verdict : verdicts)
    if (verdict.factor >= 0) mask.relative_poses[static_cast<std::size_t>(verdict.factor)] = true;
  const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares,
                                          GraduatedParams{}, optimizer, progress);
  apply_weights(summary.weights, mask, graph);
}

}  // namespace

template <class Pose>
std::vector<MatchVerdict> admit_matches(JointGraph<Pose>& joint, const Mission& mission,
                                        const std::vector<CandidateResult>& candidates, Pruning pruning,
                                        const MatchParams& params,
                                        const ArrivalLikelihoodParams& likelihood) {
  return Admission<Pose>(joint, mission, candidates, pruning, params, likelihood).run();
}

template <class Pose>
void settle_matches(JointGraph<Pose>& joint, std::vector<MatchVerdict>& verdicts, const MatchParams& params,
                    const OptimizerParams& optimizer, const Progress& progress) {
  auto& graph = joint.team.graph;
  if (params.robust)
    optimize_graduated_matches(joint, verdicts, optimizer, progress);
  else
    optimize(graph, optimizer, progress);
  for (MatchVerdict& verdict : verdicts) {
    if (verdict.factor < 0) continue;
    const auto& factor = graph.relative_poses[static_cast<std::size_t>(verdict.factor)];
    verdict.statistic = squared_norm(graph, factor);
    if (factor.weight < kLeastShare) verdict = reject(verdict, "the joint estimate disagrees");
  }
}

#define RADIOSLAM_MATCH_STAGE(Pose)                                                                     \
  template std::vector<MatchVerdict> admit_matches(JointGraph<Pose>&, const Mission&,                   \
                                                   const std::vector<CandidateResult>&, Pruning,        \
                                                   const MatchParams&, const ArrivalLikelihoodParams&); \
  template void settle_matches(JointGraph<Pose>&, std::vector<MatchVerdict>&, const MatchParams&,       \
                               const OptimizerParams&, const Progress&);
RADIOSLAM_MATCH_STAGE(SE2)
RADIOSLAM_MATCH_STAGE(SE3)
#undef RADIOSLAM_MATCH_STAGE

}  // namespace radioslam

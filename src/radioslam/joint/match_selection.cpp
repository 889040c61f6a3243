#include "radioslam/joint/match_selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/consistency/consistent_set.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
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

MatchOutcome reject(MatchOutcome outcome, std::string reason) {
  outcome.status = ClosureStatus::kRejected;
  outcome.reason = std::move(reason);
  return outcome;
}

constexpr double kMinRatio = 0.5;  // ratio of its information below which a match counts as rejected

/// A match that has passed the tests so far.
struct Admitted {
  std::size_t index = 0;  ///< in the mission
  PoseId i, j;
};

template <class Pose>
class MatchSelector {
 public:
  MatchSelector(JointGraph<Pose>& joint, const Mission& mission,
                const std::vector<CandidateResult>& candidates, Pruning pruning, const MatchParams& params,
                const AoaLikelihoodParams& likelihood)
      : joint_(joint), mission_(mission), candidates_(keys(candidates)), pruning_(pruning), params_(params) {
    if (params.angle_weights) angles_.emplace(mission, params, likelihood);
    for (std::size_t m = 0; m < mission.matches.size(); ++m) outcomes_.push_back(admit(m));
  }

  std::vector<MatchOutcome> run() {
    if (params_.robust)
      for (const auto& [robots, matches] : between_robots_) keep_consistent(matches);
    for (const Admitted& match : admitted_)
      if (outcomes_[match.index].status == ClosureStatus::kAccepted) add_match(match);
    return std::move(outcomes_);
  }

 private:
  MatchOutcome admit(std::size_t index) {
    const PoseMatch& match = mission_.matches[index];
    MatchOutcome outcome;
    const FactorOrigin& origin = outcome.origin = {FactorSource::kMatch,
                                                   index,
                                                   match.robot_i,
                                                   match.robot_j,
                                                   keyframe_stamp(joint_, match.robot_i, match.stamp_i),
                                                   keyframe_stamp(joint_, match.robot_j, match.stamp_j)};
    const PoseId i = pose_at(joint_, match.robot_i, match.stamp_i);
    const PoseId j = pose_at(joint_, match.robot_j, match.stamp_j);
    if (!i.valid() || !j.valid()) return reject(outcome, "no odometry at its time");
    const bool other = match.robot_i != match.robot_j;
    if (other && pruning_ == Pruning::kOn &&
        !candidates_.contains({origin.robot_i, origin.stamp_i, origin.robot_j, origin.stamp_j}))
      return reject(outcome, "the views cannot overlap");
    if (other) between_robots_[std::minmax(match.robot_i, match.robot_j)].push_back(admitted_.size());
    admitted_.push_back({index, i, j});
    return outcome;
  }

  /// Rejects all matches of a pair of robots except the largest consistent set.
  void keep_consistent(const std::vector<std::size_t>& group) {
    const PoseMatch& first = mission_.matches[admitted_[group.front()].index];
    const auto [a, b] = std::minmax(first.robot_i, first.robot_j);
    std::vector<RelativePoseMatch<Pose>> matches;
    for (const std::size_t k : group) matches.push_back(oriented(admitted_[k], a));
    const ConsistentSet set = largest_consistent_set(chain(a), chain(b), matches);
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (set.matches[k].is_in) continue;
      MatchOutcome& outcome = outcomes_[admitted_[group[k]].index];
      outcome.statistic = set.matches[k].best_statistic.value_or(0);
      outcome = reject(outcome, "not consistent with the largest set of matches");
    }
  }

  RelativePoseMatch<Pose> oriented(const Admitted& match, RobotIndex a) const {
    const PoseMatch& measured = mission_.matches[match.index];
    const Pose T_i_j = pose_as<Pose>(measured.T_i_j);
    const typename Pose::Jacobian covariance = inverse(match_information<Pose>(measured));
    const auto node_in_segment = [&](PoseId id, RobotIndex robot) {
      return id.index() - segment(robot).first_pose;
    };
    if (measured.robot_i == a)
      return {node_in_segment(match.i, measured.robot_i), node_in_segment(match.j, measured.robot_j), T_i_j,
              covariance};
    const typename Pose::Jacobian turn = T_i_j.adjoint();
    return {node_in_segment(match.j, measured.robot_j), node_in_segment(match.i, measured.robot_i),
            T_i_j.inverse(), congruence(turn, covariance)};
  }

  /// Robots of a mission have one segment each.
  const TrajectorySegment& segment(RobotIndex robot) const { return joint_.team.segments[robot.index()]; }

  OdometryChain<Pose> chain(RobotIndex robot) const {
    const TrajectorySegment& of = segment(robot);
    std::vector<Pose> poses{Pose()};
    std::vector<typename Pose::Jacobian> steps;
    for (const auto& factor : joint_.team.graph.relative_poses) {
      const bool mine =
          factor.i.index() == of.first_pose + poses.size() - 1 && factor.j.value == factor.i.value + 1;
      if (!mine || poses.size() == of.pose_count) continue;
      poses.push_back(poses.back() * factor.T_i_j);
      steps.push_back(inverse(factor.information));
    }
    return {std::move(poses), steps};
  }

  void add_match(const Admitted& match) {
    const PoseMatch& measured = mission_.matches[match.index];
    RelativePoseFactor<Pose> factor;
    factor.i = match.i;
    factor.j = match.j;
    factor.T_i_j = pose_as<Pose>(measured.T_i_j);
    factor.information = match_information<Pose>(measured);
    if (params_.robust) factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
    MatchOutcome& outcome = outcomes_[match.index];
    if (angles_ && measured.robot_i != measured.robot_j)
      outcome.angle_scale = angles_->template information_scale<Pose>(measured);
    if (outcome.angle_scale.value_or(1) < kMinRatio) {
      outcome = reject(outcome, "the angles of arrival disagree");
      return;
    }
    factor.information *= outcome.angle_scale.value_or(1);
    add_factor(joint_, factor, outcome.origin);
  }

  JointGraph<Pose>& joint_;
  const Mission& mission_;
  std::set<CandidateKey> candidates_;
  Pruning pruning_;
  MatchParams params_;
  std::optional<AoaMatchWeights> angles_;  ///< only with angle_weights
  std::vector<Admitted> admitted_;
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<std::size_t>>
      between_robots_;  ///< indices into admitted_
  std::vector<MatchOutcome> outcomes_;
};

/// With a redescending loss, under which outliers lose their influence.
template <class Pose>
void optimize_graduated_matches(JointGraph<Pose>& joint, const OptimizerParams& optimizer,
                                const Progress& progress) {
  auto& graph = joint.team.graph;
  FactorMask mask;
  for (const FactorOrigin& origin : joint.origins.relative_poses)
    mask.relative_poses.push_back(origin.source == FactorSource::kMatch);
  const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares,
                                          GraduatedParams{}, optimizer, progress);
  apply_weights(summary.weights, mask, graph);
}

}  // namespace

template <class Pose>
std::vector<MatchOutcome> select_matches(JointGraph<Pose>& joint, const Mission& mission,
                                         const std::vector<CandidateResult>& candidates, Pruning pruning,
                                         const MatchParams& params, const AoaLikelihoodParams& likelihood) {
  return MatchSelector<Pose>(joint, mission, candidates, pruning, params, likelihood).run();
}

template <class Pose>
void optimise_with_matches(JointGraph<Pose>& joint, std::vector<MatchOutcome>& outcomes,
                           const MatchParams& params, const OptimizerParams& optimizer,
                           const Progress& progress) {
  auto& graph = joint.team.graph;
  if (params.robust)
    optimize_graduated_matches(joint, optimizer, progress);
  else
    optimize(graph, optimizer, progress);
  for (std::size_t k = 0; k < graph.relative_poses.size(); ++k) {
    const FactorOrigin& origin = joint.origins.relative_poses[k];
    if (origin.source != FactorSource::kMatch) continue;
    const auto& factor = graph.relative_poses[k];
    MatchOutcome& outcome = outcomes[origin.measurement];
    outcome.statistic = squared_norm(graph, factor);
    if (factor.weight < kMinRatio) outcome = reject(outcome, "the joint estimate disagrees");
  }
}

#define RADIOSLAM_MATCH_STAGE(Pose)                                                                      \
  template std::vector<MatchOutcome> select_matches(JointGraph<Pose>&, const Mission&,                   \
                                                    const std::vector<CandidateResult>&, Pruning,        \
                                                    const MatchParams&, const AoaLikelihoodParams&);     \
  template void optimise_with_matches(JointGraph<Pose>&, std::vector<MatchOutcome>&, const MatchParams&, \
                                      const OptimizerParams&, const Progress&);
RADIOSLAM_MATCH_STAGE(SE2)
RADIOSLAM_MATCH_STAGE(SE3)
#undef RADIOSLAM_MATCH_STAGE

}  // namespace radioslam

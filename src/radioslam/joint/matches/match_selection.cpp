#include "radioslam/joint/matches/match_selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "radioslam/consistency/consistent_set.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/matches/alignment_by_matches.hpp"
#include "radioslam/joint/segment_odometry.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

namespace radioslam {
namespace {

constexpr double kMinRatio = 0.5;  // ratio of its information below which a match counts as rejected

/// Smallest consistent set that can admit matches which the joint estimate rejects.
constexpr std::size_t kMinVouching = 3;

template <class Pose>
class MatchSelector {
 public:
  MatchSelector(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                const std::vector<Closure>& matches, std::vector<ClosureJudgement>& judgements,
                const CandidateList& candidates, Pruning pruning, const MatchParams& params,
                const AoaMatchWeights* angles, const std::optional<RadioCovariance<Pose>>& radio,
                const ConsistencyParams& consistency)
      : joint_(joint),
        alignment_(alignment),
        matches_(matches),
        judgements_(judgements),
        candidates_(candidates),
        pruning_(pruning),
        params_(params),
        angles_(angles),
        radio_(radio),
        consistency_(consistency) {}

  void run() {
    for (std::size_t m = 0; m < matches_.size(); ++m) admit(m);
    if (params_.robust)
      for (const auto& [robots, group] : between_robots_) keep_consistent(group);
    for (const MatchEnds& ends : admitted_)
      if (judgements_[ends.match].status == ClosureStatus::kAccepted) add_match(ends);
  }

 private:
  void admit(std::size_t index) {
    const Closure& match = matches_[index];
    const auto [i, j] = closure_ends(joint_, match);
    if (!i.valid() || !j.valid()) return reject(judgements_[index], "no odometry at its time");
    const MatchEnds ends{index, i, j};
    const bool other = match.robot_i != match.robot_j;
    const bool is_tested = other && pruning_ == Pruning::kOn &&
                           connected_without_matches(alignment_, match.robot_i, match.robot_j);
    if (is_tested && !is_candidate(match)) return set_aside(ends, "the views cannot overlap");
    if (is_tested && contradicts_radio(ends))
      return set_aside(ends, "its relative pose contradicts the radio");
    if (other && pruning_ == Pruning::kOn && !is_tested &&
        alignment_.component[match.robot_i.index()] != alignment_.component[match.robot_j.index()])
      return reject(judgements_[index], "no group of matches stands out");
    if (other) between_robots_[std::minmax(match.robot_i, match.robot_j)].push_back(admitted_.size());
    admitted_.push_back(ends);
  }

  bool is_candidate(const Closure& match) const {
    return candidates_.contains(match.robot_i, keyframe_stamp(joint_, match.robot_i, match.stamp_i),
                                match.robot_j, keyframe_stamp(joint_, match.robot_j, match.stamp_j));
  }

  /// Keeps a match that the joint estimate rejects, in case an accepted set vouches for it.
  void set_aside(const MatchEnds& ends, std::string reason) {
    const Closure& match = matches_[ends.match];
    set_aside_[std::minmax(match.robot_i, match.robot_j)].push_back(ends);
    reject(judgements_[ends.match], std::move(reason));
  }

  /// Sets the statistic where radio links tell the robots' relative pose.
  bool contradicts_radio(const MatchEnds& ends) {
    if (!radio_ || !params_.robust) return false;
    double& statistic = judgements_[ends.match].statistic;
    statistic = match_statistic(joint_, radio_->marginals, radio_->temperature, matches_[ends.match], ends);
    return statistic > kPoseChiSquared999<Pose>;
  }

  using Oriented = std::vector<RelativePoseMatch<Pose>>;

  RelativePoseMatch<Pose> oriented(const MatchEnds& ends, RobotIndex a) const {
    return oriented_match(joint_, matches_[ends.match], ends, a);
  }

  /// Rejects all matches of a pair of robots except the largest consistent set, and admits those set aside
  /// that are consistent with all of it: a group of matches is one relative pose of the robots' frames, true
  /// or false as a whole, while the trajectory that set some aside may be bent.
  void keep_consistent(const std::vector<std::size_t>& group) {
    if (!are_enough(group.size(), consistency_)) return reject_group(group);
    const Closure& first = matches_[admitted_[group.front()].match];
    const auto [a, b] = std::minmax(first.robot_i, first.robot_j);
    const auto& segments = joint_.team.segments;  // robots of a mission have one each
    const auto chain_a = odometry_chain(joint_, segments[a.index()]),
               chain_b = odometry_chain(joint_, segments[b.index()]);
    Oriented matches, members;
    for (const std::size_t k : group) matches.push_back(oriented(admitted_[k], a));
    const ConsistentSet set =
        largest_consistent_set(chain_a, chain_b, matches, {pairwise_params(consistency_), {}});
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (set.matches[k].is_in) {
        members.push_back(matches[k]);
        continue;
      }
      ClosureJudgement& judgement = judgements_[admitted_[group[k]].match];
      judgement.statistic = set.matches[k].best_statistic.value_or(0);
      reject(judgement, "not consistent with the largest set of matches");
    }
    if (members.size() < kMinVouching || has_unit_weights(consistency_)) return;
    std::vector<MatchEnds> vouched_for;
    Oriented extension;
    for (const MatchEnds& ends : set_aside_[{a, b}]) {
      const RelativePoseMatch<Pose> match = oriented(ends, a);
      if (std::any_of(members.begin(), members.end(), [&](const auto& member) {
            return pair_statistic(chain_a, chain_b, match, member) > set.gate;
          }))
        continue;
      vouched_for.push_back(ends);
      extension.push_back(match);
    }
    if (extension.empty()) return;
    for (const std::size_t k : largest_consistent_set(chain_a, chain_b, extension).members) {
      judgements_[vouched_for[k].match].status = ClosureStatus::kAccepted;
      judgements_[vouched_for[k].match].reason.clear();
      admitted_.push_back(vouched_for[k]);
    }
  }

  void reject_group(const std::vector<std::size_t>& group) {
    for (const std::size_t k : group)
      reject(judgements_[admitted_[k].match], "too few matches between the robots");
  }

  void add_match(const MatchEnds& ends) {
    const Closure& match = matches_[ends.match];
    std::optional<double> scale;
    if (angles_ && match.robot_i != match.robot_j) scale = angles_->template information_scale<Pose>(match);
    if (scale.value_or(1) < kMinRatio)
      return reject(judgements_[ends.match], "the angles of arrival disagree");
    RelativePoseFactor<Pose> factor = closure_factor(joint_, match);
    factor.information *= scale.value_or(1);
    if (params_.robust) factor.loss = {LossKind::kGemanMcClure, std::sqrt(kPoseChiSquared99<Pose>)};
    add_closure(joint_, match, std::move(factor), FactorSource::kMatch, ends.match);
  }

  JointGraph<Pose>& joint_;
  const TeamAlignment<Pose>& alignment_;
  const std::vector<Closure>& matches_;
  std::vector<ClosureJudgement>& judgements_;
  const CandidateList& candidates_;
  Pruning pruning_;
  MatchParams params_;
  const AoaMatchWeights* angles_;
  const std::optional<RadioCovariance<Pose>>& radio_;
  const ConsistencyParams& consistency_;
  std::vector<MatchEnds> admitted_;
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<std::size_t>>
      between_robots_;  ///< indices into admitted_
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<MatchEnds>> set_aside_;
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
std::optional<RadioCovariance<Pose>> radio_covariance(const JointGraph<Pose>& joint,
                                                      const TeamAlignment<Pose>& alignment,
                                                      const RadioAlignmentParams& params) {
  if (alignment.segments.of_segment.empty()) return std::nullopt;
  auto marginals = Marginals<Pose>::compute(graph_for_covariances(joint, params.mixture).team.graph);
  if (!marginals) return std::nullopt;
  return RadioCovariance<Pose>{std::move(*marginals), params.beam.evidence_temperature};
}

template <class Pose>
std::vector<KeyframePair> keyframes_of_matches(const JointGraph<Pose>& joint,
                                               const std::vector<Closure>& matches) {
  std::vector<KeyframePair> pairs;
  for (const Closure& match : matches)
    if (match.robot_i != match.robot_j)
      pairs.push_back({match.robot_i, keyframe_stamp(joint, match.robot_i, match.stamp_i), match.robot_j,
                       keyframe_stamp(joint, match.robot_j, match.stamp_j)});
  return pairs;
}

template <class Pose>
void select_matches(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                    const std::vector<Closure>& matches, std::vector<ClosureJudgement>& judgements,
                    const CandidateList& candidates, Pruning pruning, const MatchParams& params,
                    const AoaMatchWeights* angles, const std::optional<RadioCovariance<Pose>>& radio,
                    const ConsistencyParams& consistency) {
  MatchSelector<Pose>(joint, alignment, matches, judgements, candidates, pruning, params, angles, radio,
                      consistency)
      .run();
}

template <class Pose>
void optimize_with_matches(JointGraph<Pose>& joint, std::vector<ClosureJudgement>& judgements,
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
    ClosureJudgement& judgement = judgements[origin.measurement];
    judgement.statistic = squared_norm(graph, factor);
    if (factor.weight < kMinRatio) reject(judgement, "the joint estimate disagrees");
  }
}

namespace {

/// Pairs with enough accepted matches to determine their relative pose.
PairsOfRobots pairs_with_matches(const std::vector<Closure>& matches,
                                 const std::vector<ClosureJudgement>& judgements) {
  std::map<std::pair<RobotIndex, RobotIndex>, std::size_t> accepted;
  for (std::size_t m = 0; m < matches.size(); ++m)
    if (judgements[m].status == ClosureStatus::kAccepted && matches[m].robot_i != matches[m].robot_j)
      ++accepted[std::minmax(matches[m].robot_i, matches[m].robot_j)];
  PairsOfRobots pairs;
  for (const auto& [robots, count] : accepted)
    if (count >= kMinVouching) pairs.insert(robots);
  return pairs;
}

/// Sets the status of every match in the graph by its error there; rejected ones lose their weight.
template <class Pose>
void retest_matches(JointGraph<Pose>& joint, std::vector<ClosureJudgement>& judgements) {
  test_closures(joint, FactorSource::kMatch, judgements);
  for (std::size_t k = 0; k < joint.origins.relative_poses.size(); ++k) {
    const FactorOrigin& origin = joint.origins.relative_poses[k];
    if (origin.source != FactorSource::kMatch) continue;
    const bool fits = judgements[origin.measurement].status == ClosureStatus::kAccepted;
    joint.team.graph.relative_poses[k].weight = fits ? 1 : 0;
  }
}

/// Log likelihood of the joint estimate, in which a rejected match costs as much as one at its gate.
template <class Pose>
double optimize_and_reweigh(JointGraph<Pose>& joint, std::vector<ClosureJudgement>& judgements,
                            const TeamAlignment<Pose>& alignment, const MatchParams& params,
                            const MixtureParams& mixture, const OptimizerParams& optimizer,
                            const Progress& progress) {
  constexpr int kRounds = 3;
  const auto is_accepted = [](const ClosureJudgement& o) { return o.status == ClosureStatus::kAccepted; };
  const auto before = std::count_if(judgements.begin(), judgements.end(), is_accepted);
  optimize_with_matches(joint, judgements, params, optimizer, progress);
  for (int round = 0; round < kRounds; ++round) {
    reweigh_radio_links(joint, alignment, mixture);
    retest_matches(joint, judgements);
    optimize(joint.team.graph, optimizer, progress);
  }
  retest_matches(joint, judgements);
  const auto lost = before - std::count_if(judgements.begin(), judgements.end(), is_accepted);
  return reweigh_radio_links(joint, alignment, mixture) -
         static_cast<double>(lost) * kPoseChiSquared99<Pose> / 2;
}

}  // namespace

template <class Pose>
void optimize_matches_and_radio(JointGraph<Pose>& joint, const std::vector<Closure>& matches,
                                std::vector<ClosureJudgement>& judgements,
                                const TeamAlignment<Pose>& alignment, const MatchParams& params,
                                const MixtureParams& mixture, const OptimizerParams& optimizer,
                                const Progress& progress) {
  JointGraph<Pose> matches_first = joint;
  std::vector<ClosureJudgement> judgements_first = judgements;
  const double by_radio =
      optimize_and_reweigh(joint, judgements, alignment, params, mixture, optimizer, progress);
  const PairsOfRobots pairs = pairs_with_matches(matches, judgements_first);
  silence_links(matches_first, pairs);
  if (!pairs.empty() && optimize_and_reweigh(matches_first, judgements_first, alignment, params, mixture,
                                             optimizer, progress) > by_radio) {
    joint = std::move(matches_first);
    judgements = std::move(judgements_first);
  }
  optimize(joint.team.graph, optimizer, progress);  // with the weights that were set last
}

#define RADIOSLAM_MATCH_STAGE(Pose)                                                                          \
  template std::optional<RadioCovariance<Pose>> radio_covariance(                                            \
      const JointGraph<Pose>&, const TeamAlignment<Pose>&, const RadioAlignmentParams&);                     \
  template std::vector<KeyframePair> keyframes_of_matches(const JointGraph<Pose>&,                           \
                                                          const std::vector<Closure>&);                      \
  template void select_matches(JointGraph<Pose>&, const TeamAlignment<Pose>&, const std::vector<Closure>&,   \
                               std::vector<ClosureJudgement>&, const CandidateList&, Pruning,                \
                               const MatchParams&, const AoaMatchWeights*,                                   \
                               const std::optional<RadioCovariance<Pose>>&, const ConsistencyParams&);       \
  template void optimize_matches_and_radio(JointGraph<Pose>&, const std::vector<Closure>&,                   \
                                           std::vector<ClosureJudgement>&, const TeamAlignment<Pose>&,       \
                                           const MatchParams&, const MixtureParams&, const OptimizerParams&, \
                                           const Progress&);                                                 \
  template void optimize_with_matches(JointGraph<Pose>&, std::vector<ClosureJudgement>&, const MatchParams&, \
                                      const OptimizerParams&, const Progress&);
RADIOSLAM_MATCH_STAGE(SE2)
RADIOSLAM_MATCH_STAGE(SE3)
#undef RADIOSLAM_MATCH_STAGE

}  // namespace radioslam

// Match selection: decides which matches of an external place recognition enter the joint graph.
//
// With pruning, a match between two robots is admitted only if the keyframes before its ends are a candidate
// pair of the overlap search and, where radio links determine the robots' relative pose, if its own relative
// pose passes the chi-squared test under the joint estimate. Matches within one robot, and between robots
// that matches alone connect, are not tested so; those between robots that nothing connects are rejected. The
// largest pairwise consistent set (PCM, under the odometry's covariance) joins the graph; from three members
// on, it also admits the rejected matches that are consistent with all of it, except with unit weights
// (consistency_params.hpp). Each match has a robust loss that can still reject it. Optionally, angles of
// arrival measured near a match scale its information; a match that keeps less than half of it is rejected.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/aoa/aoa_match_weights.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/overlap_stage.hpp"
#include "radioslam/joint/team_alignment.hpp"

namespace radioslam {

enum class Pruning {
  kOn,
  kOff,  ///< admits every match, to measure the effect of pruning
};

/// Covariances of relative poses before any match joins the graph.
template <class Pose>
struct RadioCovariance {
  Marginals<Pose> marginals;
  double temperature = 1;  ///< factor on covariances, since links share errors
};

/// Nothing if the team was not placed by radio links or the estimate's covariances are singular.
template <class Pose>
std::optional<RadioCovariance<Pose>> radio_covariance(const JointGraph<Pose>& joint,
                                                      const TeamAlignment<Pose>& alignment,
                                                      const RadioAlignmentParams& params);

/// The keyframes before the ends of every match between two robots.
template <class Pose>
std::vector<KeyframePair> keyframes_of_matches(const JointGraph<Pose>& joint,
                                               const std::vector<Closure>& matches);

/// Judges every match and adds factors for those accepted. `joint` must be optimized and placed.
/// `candidates`: all that are keyframes of a match. `angles`: scales each match's information, if given.
template <class Pose>
void select_matches(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                    const std::vector<Closure>& matches, std::vector<ClosureJudgement>& judgements,
                    const CandidateList& candidates, Pruning pruning, const MatchParams& params,
                    const AoaMatchWeights* angles = nullptr,
                    const std::optional<RadioCovariance<Pose>>& radio = {},
                    const ConsistencyParams& consistency = {});

/// As optimize_with_matches, for a team placed by radio links. Where the links between two robots contradict
/// their matches, either may be wrong. So the team is optimized twice: with the radio's weights kept until
/// the matches have joined, and with the links between such robots left out until then. Both recompute all
/// weights afterwards, and the likelier solution is the result.
template <class Pose>
void optimize_matches_and_radio(JointGraph<Pose>& joint, const std::vector<Closure>& matches,
                                std::vector<ClosureJudgement>& judgements,
                                const TeamAlignment<Pose>& alignment, const MatchParams& params,
                                const MixtureParams& mixture, const OptimizerParams& optimizer,
                                const Progress& progress);

/// Optimizes with a graduated loss on the matches, which may still reject some; or, if `robust` is off, by
/// plain least squares with all of them.
template <class Pose>
void optimize_with_matches(JointGraph<Pose>& joint, std::vector<ClosureJudgement>& judgements,
                           const MatchParams& params, const OptimizerParams& optimizer,
                           const Progress& progress);

}  // namespace radioslam

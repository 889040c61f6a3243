// Match selection: decides which matches of an external place recognition enter the joint graph.
//
// With pruning, a match between two robots is admitted only if the keyframes before its ends are a candidate
// pair of the overlap search; matches within one robot are always admitted. The largest pairwise consistent
// set (PCM, under the odometry's covariance) joins the graph, each match with a robust loss that can still
// reject it. Optionally, angles of arrival measured near a match scale its information; a match that keeps
// less than half of it is rejected.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/aoa/aoa_match_weights.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/overlap_stage.hpp"

namespace radioslam {

enum class Pruning {
  kOn,
  kOff,  ///< admits every match, to measure the effect of pruning
};

/// A match and its outcome.
struct MatchOutcome {
  FactorOrigin origin;
  ClosureStatus status = ClosureStatus::kAccepted;
  double statistic = 0;
  std::string reason;
  std::optional<double> angle_scale = {};  ///< scale of its information; absent without angles near it
};

/// Tests every match and adds factors for those accepted. `joint` must be optimised and placed.
template <class Pose>
std::vector<MatchOutcome> select_matches(JointGraph<Pose>& joint, const Mission& mission,
                                         const std::vector<CandidateResult>& candidates, Pruning pruning,
                                         const MatchParams& params, const AoaLikelihoodParams& likelihood);

/// Optimises with a graduated loss on the matches, which may still reject some; or, if `robust` is off, by
/// plain least squares with all of them.
template <class Pose>
void optimise_with_matches(JointGraph<Pose>& joint, std::vector<MatchOutcome>& outcomes,
                           const MatchParams& params, const OptimizerParams& optimizer,
                           const Progress& progress);

}  // namespace radioslam

// Relative poses from someone else's place recognition: which are admitted, and what becomes of them.
// With pruning, a match of two robots is admitted when the keyframes before its two ends are a candidate pair
// of the overlap search; matches within a robot always are. Of those admitted, the largest set that is
// pairwise consistent under the odometry's covariance joins the graph, each with a loss that can still drop
// it. On request, the angles of arrival measured near a match of two robots scale its information; one that
// they leave less than half of it stays out of the graph.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/match_angles.hpp"
#include "radioslam/pipeline/overlap_stage.hpp"

namespace radioslam {

enum class Pruning {
  kOn,
  kOff,  ///< every match is admitted, to show what pruning is good for
};

/// A match and what became of it; `factor` is its place in graph.relative_poses, or -1.
struct MatchVerdict {
  RadioTie tie;
  ClosureStatus status = ClosureStatus::kAccepted;
  double statistic = 0;
  std::string reason;
  std::ptrdiff_t factor = -1;
  std::optional<double> angle_scale = {};  ///< of its information; absent where no angles tell
};

/// Decides on every match and adds the factors of those accepted. The joint graph is placed and optimised.
template <class Pose>
std::vector<MatchVerdict> admit_matches(JointGraph<Pose>& joint, const Mission& mission,
                                        const std::vector<CandidateResult>& candidates, Pruning pruning,
                                        const MatchParams& params, const ArrivalLikelihoodParams& likelihood);

/// Optimises with graduated losses on the matches, which may reject some of them after all; with all of them
/// under least squares where they are not to be robust.
template <class Pose>
void settle_matches(JointGraph<Pose>& joint, std::vector<MatchVerdict>& verdicts, const MatchParams& params,
                    const OptimizerParams& optimizer, const Progress& progress);

}  // namespace radioslam

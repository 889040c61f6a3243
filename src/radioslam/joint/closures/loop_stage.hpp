// The loops of a team in its estimate: they correct trajectories, align robots, and are judged together.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

class MapWitness;

/// Corrects every trajectory by its robot's own loops, in its own frame; those that fit become factors.
template <class Pose>
void add_own_loops(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                   const OptimizerParams& optimizer);

/// Joins the components that loops connect, and solves the team with the loops that hold; judges every
/// closure. The alignment notes what stands on loops alone, what they leave open, and stated
/// covariances that do not hold. With unit weights every pair of robots that has a consistent set is joined
/// by its largest, however weak; the joint estimate still judges each loop under its covariance. Nothing
/// where no closure has both ends in the graph. `maps`: what the robots' scans say of closures between them,
/// if they have any.
template <class Pose>
std::optional<LoopChoiceResult> close_by_loops(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                                               const std::vector<Closure>& closures,
                                               std::vector<ClosureJudgement>& judgements,
                                               const OptimizerParams& optimizer, const Progress& progress,
                                               const ConsistencyParams& consistency = {},
                                               const MapWitness* maps = nullptr);

}  // namespace radioslam

// The loops of a team in its estimate: they correct trajectories, align robots, and are judged together.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/links/radio_covariance.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

class MapWitness;

/// Corrects every trajectory by its robot's own loops, in its own frame; those that fit become factors.
template <class Pose>
void add_own_loops(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                   const OptimizerParams& optimizer);

/// What other evidence says of closures and frames.
template <class Pose>
struct ClosureEvidence {
  std::vector<ClosureAdmission> admissions = {};    ///< per closure; empty: all may take part
  std::optional<RadioCovariance<Pose>> radio = {};  ///< where links relate robots
  const MixtureParams* links = nullptr;             ///< by which links are weighed; null: there are none
  const MapWitness* maps = nullptr;                 ///< what scans say; null: there are none
  ConsistencyParams consistency = {};
};

/// Joins the components that loops connect, and solves the team with the loops that hold; judges every
/// closure. The alignment notes what stands on loops alone, what they leave open, and stated
/// covariances that do not hold. With unit weights every pair of robots that has a consistent set is joined
/// by its largest, however weak; the joint estimate still judges each loop under its covariance. Nothing
/// where no closure has both ends in the graph.
/// Where links between two robots contradict the loops that hold, either may be wrong: the team is solved
/// with these links and without them, both weigh all links again, and the likelier solution is the result.
template <class Pose>
std::optional<LoopChoiceResult> close_by_loops(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                                               const std::vector<Closure>& closures,
                                               std::vector<ClosureJudgement>& judgements,
                                               const ClosureEvidence<Pose>& evidence,
                                               const OptimizerParams& optimizer, const Progress& progress);

/// Solves the team by least squares with every closure that is admitted, to see what they do on their own.
template <class Pose>
void close_by_all(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                  const std::vector<ClosureAdmission>& admissions, std::vector<ClosureJudgement>& judgements,
                  const OptimizerParams& optimizer, const Progress& progress);

}  // namespace radioslam

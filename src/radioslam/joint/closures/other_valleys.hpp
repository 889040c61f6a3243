// Solutions in other valleys of the truncated cost.
//
// Least squares over odometry and loops that may be wrong, min sum of squares + sum over loops of min(s,
// gate), has many local optima: each is a choice of loops with the trajectory bent to them. Loops that agree
// with one another along the odometry, at both ends, are right or wrong together, so a solution is left by a
// whole group at once: one that is rejected holds and what contradicts it must pay, or one that is accepted
// goes. The graph is solved from there, all loops are judged again, and the result is taken where its cost is
// lower. The groups with most at stake come first; a group is tried again only after the solution has
// changed, and the number of trials is bounded.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/team_loops.hpp"

namespace radioslam {

/// A team with all of its loops as factors, each in the solution (weight 1) or not (0).
template <class Pose>
struct LoopChoice {
  PoseGraph<Pose> graph;                ///< its last relative poses are the loops
  std::vector<bool> is_odometry;        ///< per relative pose before the loops
  std::vector<Pose> own_shape;          ///< the trajectories, each as it is without the other robots
  std::vector<std::size_t> segment_of;  ///< per pose
  std::vector<double> gates;            ///< per loop: squared norm from which it costs no more
  std::vector<bool> may_hold;           ///< per loop: whether its ends are in one frame
  std::vector<bool> accepted;           ///< per loop

  std::size_t first_loop() const { return graph.relative_poses.size() - gates.size(); }
};

/// The graph's cost with every loop that may hold truncated at its gate, whether it is accepted or not.
template <class Pose>
double truncated_cost(const LoopChoice<Pose>& choice);

/// Moves a choice, whose graph is at the optimum of its accepted loops, to the best solution that trials lead
/// to.
template <class Pose>
void leave_valleys(LoopChoice<Pose>& choice, const OptimizerParams& optimizer);

}  // namespace radioslam

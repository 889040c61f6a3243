// Which of the position fixes hold, found by following the way: what is near to fixes that hold is judged
// first, when the odometry in between still tells.
//
// Solving for all fixes at once lets a spell of wrong ones bend the way towards itself until it fits. So the
// set that holds grows from seeds: in each round the way is bent to the set (Geman-McClure), and then
//   a fix passes when  r^2 <= gate (sigma^2 + u^2),   u = drift_share * way to the nearest fix of the set,
// leaves the set when it does not pass, and joins it when it does and u is below sigma, or least of all that
// pass (times reach): an outage of fixes is crossed from its rim. Ends when the set stays, or after
// most_rounds. Cost: an optimisation per round, of all robots together.
#pragma once

#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/team_frame/fix_alignment.hpp"

namespace radioslam {

/// A robot's fixes, in the order of time, with what is known of them.
template <class Pose>
struct GrowingFixes {
  std::vector<PositionFactor<Pose>> factors;
  std::vector<FixOfWay> of_way;  ///< the same fixes
  std::vector<double> seeds_m;   ///< metres of way where the values are right at first
  std::vector<bool> holds;       ///< the set; empty at first
};

/// Factors that only matter while the set grows; in units of their own.
struct FixGrowthParams {
  double gate = 9.21;         ///< chi-squared
  double drift_share = 0.03;  ///< of the way that odometry may drift
  double reach = 1.25;        ///< see above
  int most_rounds = 200;
};

/// Bends graph.poses and drifts to the fixes that hold, and finds these. graph.positions must be empty, and
/// is again. Values have every robot near its fixes about its seeds.
template <class Pose>
void grow_fixes(PoseGraph<Pose>& graph, std::vector<GrowingFixes<Pose>>& team, const FixGrowthParams& params,
                const OptimizerParams& optimizer);

}  // namespace radioslam

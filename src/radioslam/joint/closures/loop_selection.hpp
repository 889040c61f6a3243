// Which loops of an aligned team hold: the team is solved with those accepted so far, and every loop is
// tested against the solution, again and again until nothing changes.
//
// A loop that is in the solution is tested by its residual under its own covariance, one that is not under
// the sum of its own and the solution's covariance of the relative pose. So loops join from the surroundings
// of those that hold, and a loop that the others contradict leaves. Stated covariances are checked on the
// way: the variance of odometry and of loops per unit of stated variance is estimated from the residuals over
// their redundancy (variance components, Helmert 1924; Foerstner 1979), and used.
// Loops that were set aside (closure_admission.hpp) have no say in the choice; they are tested where three
// others between the same trajectories hold.
// A loop holds up to its gate (team_loops.hpp) or, where loops err more than stated, up to the 99.9 %
// quantile under the estimated covariance.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/other_valleys.hpp"
#include "radioslam/joint/closures/team_loops.hpp"

namespace radioslam {

template <class Pose>
struct LoopSelection {
  double odometry_scale = 1;  ///< actual over stated standard deviation of the odometry
  double loop_scale = 1;      ///< and of accepted loops
  double cost = 0;            ///< truncated (loop_choice.hpp), at stated covariances
  Valleys<Pose> valleys;
};

/// Moves the team, which must be aligned as far as `component` says (per segment), to the optimum of its
/// odometry and the loops that hold, and sets which do. Loops between components are not accepted. Scales are
/// those of the present covariances.
template <class Pose>
LoopSelection<Pose> select_loops(JointGraph<Pose>& joint, const std::vector<int>& component,
                                 std::vector<TeamLoop<Pose>>& loops, const OptimizerParams& optimizer,
                                 const Progress& progress);

}  // namespace radioslam

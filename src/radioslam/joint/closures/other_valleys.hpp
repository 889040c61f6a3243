// Solutions in other valleys of the truncated cost.
//
// The truncated cost (loop_choice.hpp) has many local optima: each is a choice of loops with the trajectory
// bent to them. Loops that agree with one another along the odometry are right or wrong together, so a
// solution is left by a whole group at once: one that is rejected holds and what contradicts it must pay, or
// one that is accepted goes. The graph is solved from there, all loops are judged again, and the result is
// taken where its cost is lower. The groups with most at stake come first; a group is tried again only after
// the solution has changed, and the number of trials is bounded. Solutions that cost hardly more than the
// best and put what a group ties elsewhere are alternatives.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/joint/closures/loop_choice.hpp"

namespace radioslam {

/// A group of loops that was held or dropped, and what the solution around it would have cost.
struct ValleyTrial {
  std::vector<std::size_t> loops;
  Fate fate = Fate::kHolds;
  double cost = 0;
  bool taken = false;
};

/// A solution of nearly the same cost.
template <class Pose>
struct OtherValley {
  double cost = 0;
  std::vector<bool> accepted;  ///< per loop
  std::vector<Pose> poses;
};

template <class Pose>
struct Valleys {
  std::vector<ValleyTrial> trials;        ///< in order
  std::vector<OtherValley<Pose>> others;  ///< the cheapest first
};

/// Moves a choice, whose graph is at the optimum of its accepted loops, to the best solution that trials lead
/// to.
template <class Pose>
Valleys<Pose> leave_valleys(LoopChoice<Pose>& choice, const OptimizerParams& optimizer);

}  // namespace radioslam

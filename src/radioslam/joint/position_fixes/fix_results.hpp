// Results of position fixes: counts and notes of a run.
#pragma once

#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Adds the robots' fixes, their counts, and notes on those that are not used.
template <class Pose>
void add_fix_results(RunResult& result, const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes);

}  // namespace radioslam

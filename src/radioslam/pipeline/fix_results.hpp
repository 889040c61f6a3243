// What became of position fixes: numbers and notes of a run.
#pragma once

#include "radioslam/pipeline/fix_stage.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Adds the robots' fixes, their counts and notes about those that took no part.
template <class Pose>
void add_fix_results(RunResult& result, const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes);

}  // namespace radioslam

// What a run says of its estimate: trajectories and their uncertainty, transforms, closures and their fates,
// checks, counts and notes.
//
// Wants the estimate final. Cost: the marginals of the joint graph, and access points where there are
// fingerprints.
#pragma once

#include <vector>

#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/pipeline/stage_clock.hpp"
#include "radioslam/pipeline/team_estimate.hpp"

namespace radioslam {

/// Fills `result` but for what stages before it have: candidates, range biases, timings. `loops` are those
/// of the estimate's scan_ties.
template <class Pose>
void add_run_results(RunResult& result, const Mission& mission, const TeamEstimate<Pose>& estimate,
                     const std::vector<ScanClosure>& loops, const RunParams& params,
                     const RunOptions& options, StageClock& clock);

}  // namespace radioslam

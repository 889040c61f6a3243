// Results of a run: trajectories with uncertainty, transforms, outcomes of closures, integrity tests, counts
// and notes.
//
// Needs the final estimate. Cost: the marginals of the joint graph, and the access points if there are
// fingerprints.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/joint/overlap_stage.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/results/stage_clock.hpp"

namespace radioslam {

/// Outcomes of all links and closures, by kind.
template <class Pose>
std::vector<ClosureResult> collect_all_closures(const TeamEstimate<Pose>& estimate);

/// The results of the final estimate, without timings. `measured`: the mission with all of its odometry, at
/// whose samples, and those of an IMU that `scans` were tracked with, trajectories are dense. `overlaps`:
/// nothing if no pairs were searched for.
template <class Pose>
RunResult describe_run(const Mission& mission, const Mission& measured, const MeasuredScans& scans,
                       const RadioMeasurements& radio, const TeamEstimate<Pose>& estimate,
                       std::optional<OverlapStage> overlaps, const RunParams& params,
                       const RunOptions& options, StageClock& timed);

}  // namespace radioslam

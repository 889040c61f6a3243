// The stages of a run, in the order in which run_pipeline calls them. Each takes the estimate so far by value
// and returns the next one.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/overlap_stage.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/pipeline/run_options.hpp"

namespace radioslam {

/// Whether matches may move the team; without pruning or robustness they show what they do on their own.
bool weighs_matches(const RunParams& params, const RunOptions& options);

/// The joint graph of the mission, or of `team` where it comes as a factor graph, with each robot's own loop
/// closures; `scans` are those of its scans.
template <class Pose>
TeamEstimate<Pose> begin_estimate(const Mission& mission, const TeamGraph<Pose>* team,
                                  std::vector<Closure> scans, RadioMeasurements radio,
                                  const RunParams& params, const RunOptions& options);

/// Robots with position fixes in the common frame.
template <class Pose>
TeamEstimate<Pose> place_robots_by_fixes(TeamEstimate<Pose> estimate, const Mission& mission,
                                         const RunParams& params);

/// All robots in the team frame: by radio links if there are any, else by fingerprints.
template <class Pose>
TeamEstimate<Pose> align_team(TeamEstimate<Pose> estimate, const Mission& mission, const RunParams& params,
                              const Progress& progress);

/// With the distances that fingerprints predict.
template <class Pose>
TeamEstimate<Pose> close_by_fingerprints(TeamEstimate<Pose> estimate, const RunParams& params);

/// With relative poses from similar sequences of fingerprints.
template <class Pose>
TeamEstimate<Pose> close_by_sequences(TeamEstimate<Pose> estimate, const RunParams& params);

/// Optimised, with a graduated loss on fingerprint distances.
template <class Pose>
TeamEstimate<Pose> optimise_team(TeamEstimate<Pose> estimate, const RunParams& params,
                                 const Progress& progress);

/// Optimised with the position fixes that agree with the estimate.
template <class Pose>
TeamEstimate<Pose> reclassify_fixes(TeamEstimate<Pose> estimate, const RunParams& params,
                                    const Progress& progress);

/// Refined on the team's radio field, where fingerprints laid out the team.
template <class Pose>
TeamEstimate<Pose> refine_on_field(TeamEstimate<Pose> estimate, const Mission& mission,
                                   const RunParams& params, const Progress& progress);

/// With the constant errors of ranges, per pair of antennas, where they are significant.
template <class Pose>
TeamEstimate<Pose> correct_range_biases(TeamEstimate<Pose> estimate, const RunParams& params,
                                        const Progress& progress);

/// At the alignment that radio links and groups of consistent matches support best, with the weights of all.
template <class Pose>
TeamEstimate<Pose> weigh_alignments_by_matches(TeamEstimate<Pose> estimate, const RunParams& params,
                                               const Progress& progress);

/// With the loops that hold, of a graph file or of a team that stands on matches; they join robots that
/// nothing else connects.
template <class Pose>
TeamEstimate<Pose> close_by_loops(TeamEstimate<Pose> estimate, const RunParams& params,
                                  const Progress& progress);

/// Whether a run uses the keyframe pairs with overlapping views.
bool needs_overlap_search(const Mission& mission, const RunOptions& options);

/// Keyframe pairs of different robots whose views can overlap.
template <class Pose>
OverlapStage search_overlaps(const TeamEstimate<Pose>& estimate, const RunParams& params,
                             const RunOptions& options);

/// With the matches of an external place recognition that are candidates and consistent.
template <class Pose>
TeamEstimate<Pose> close_by_matches(TeamEstimate<Pose> estimate, const Mission& mission,
                                    const OverlapStage& overlaps, const RunParams& params,
                                    const RunOptions& options, const Progress& progress);

/// With the closures of scans and sequences that the estimate agrees with; their losses have settled the
/// weights.
template <class Pose>
TeamEstimate<Pose> test_closures(TeamEstimate<Pose> estimate);

}  // namespace radioslam

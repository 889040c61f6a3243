#include "radioslam/pipeline/stages.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "radioslam/joint/closures/loop_stage.hpp"
#include "radioslam/joint/covariance_graph.hpp"
#include "radioslam/joint/field_stage.hpp"
#include "radioslam/joint/joint_graph_from_file.hpp"
#include "radioslam/joint/matches/frame_by_matches.hpp"
#include "radioslam/joint/matches/placement_by_matches.hpp"
#include "radioslam/joint/scan_closures.hpp"

namespace radioslam {
namespace {

constexpr double kMinSearchedWeight = 0.01;  // of an alignment whose overlaps are candidates, too

/// The graph of the mission, with poses at the stamps of loop closures and position fixes.
template <class Pose>
JointGraph<Pose> mission_graph(const Mission& mission, const std::vector<Closure>& scans,
                               const RunParams& params) {
  std::vector<std::vector<Stamp>> node_stamps(mission.robots.size());
  add_closure_stamps(scans, node_stamps);
  add_fix_stamps(mission, node_stamps);
  return build_joint_graph<Pose>(mission, params.keyframe, params.graph, std::move(node_stamps));
}

/// Whether the robots are connected by matches and by nothing else.
bool stands_on_matches(const Mission& mission, const RunParams& params, const RunOptions& options) {
  return weighs_matches(params, options) && !mission.matches.empty() && mission.ranges.empty() &&
         mission.aoa_measurements.empty() && !has_fixes(mission) &&
         std::all_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& r) { return r.wifi.empty(); });
}

}  // namespace

bool weighs_matches(const RunParams& params, const RunOptions& options) {
  return params.matches.robust && options.pruning == Pruning::kOn && !options.overlap_only;
}

template <class Pose>
TeamEstimate<Pose> begin_estimate(const Mission& mission, const TeamGraph<Pose>* team,
                                  std::vector<Closure> scans, RadioMeasurements radio,
                                  const RunParams& params, const RunOptions& options) {
  TeamEstimate<Pose> estimate{.radio = std::move(radio), .scans = std::move(scans)};
  estimate.joint =
      team ? joint_graph_of(*team, mission) : mission_graph<Pose>(mission, estimate.scans, params);
  estimate.starts = known_starts(mission);
  const bool are_loops = !team && stands_on_matches(mission, params, options);
  estimate.loops = team ? closures_of(*team, estimate.joint) : std::vector<Closure>();
  if (!options.overlap_only) (are_loops ? estimate.loops : estimate.matches) = closures_of_matches(mission);
  add_own_loops(estimate.joint, estimate.loops, params.optimizer);
  add_scan_closures(estimate.joint, estimate.scans, params.optimizer);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> place_robots_by_fixes(TeamEstimate<Pose> estimate, const Mission& mission,
                                         const RunParams& params) {
  estimate.fixes = place_by_fixes(estimate.joint, mission, params.fixes, params.optimizer);
  estimate.starts = starts_with_fixes<Pose>(mission, estimate.fixes);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> align_team(TeamEstimate<Pose> estimate, const Mission& mission, const RunParams& params,
                              const Progress& progress) {
  JointGraph<Pose>& joint = estimate.joint;
  estimate.placement = has_radio_links(joint)
                           ? place_by_radio(joint, params.alignment, progress)
                           : place_by_fingerprints(joint, mission, estimate.starts, estimate.radio,
                                                   params.team_frame, progress);
  constrain_by_fixes(joint, estimate.fixes, estimate.placement);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> close_by_fingerprints(TeamEstimate<Pose> estimate, const RunParams& params) {
  estimate.fingerprints = propose_fingerprint_closures(estimate.starts, estimate.radio,
                                                       params.radio.distance_model.max_trusted_path_m,
                                                       params.team_frame, params.closure);
  add_fingerprint_closures(estimate.joint, estimate.radio, estimate.fingerprints);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> close_by_sequences(TeamEstimate<Pose> estimate, const RunParams& params) {
  estimate.sequences = add_sequence_closures(estimate.joint, estimate.radio, params.sequence);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> optimise_team(TeamEstimate<Pose> estimate, const RunParams& params,
                                 const Progress& progress) {
  estimate.solution = optimize_robustly(estimate.joint, params.robust, params.optimizer, progress);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> reclassify_fixes(TeamEstimate<Pose> estimate, const RunParams& params,
                                    const Progress& progress) {
  update_fix_inliers(estimate.joint, estimate.fixes, params.optimizer, progress);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> refine_on_field(TeamEstimate<Pose> estimate, const Mission& mission,
                                   const RunParams& params, const Progress& progress) {
  if (refine_by_radio_field(estimate.joint, mission, estimate.starts, estimate.radio, estimate.placement,
                            estimate.fingerprints, params.field, progress))
    optimize(estimate.joint.team.graph, params.optimizer, progress);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> correct_range_biases(TeamEstimate<Pose> estimate, const RunParams& params,
                                        const Progress& progress) {
  estimate.range_biases = estimate_range_biases(estimate.joint, params.range_bias, params.alignment.mixture,
                                                params.optimizer, progress);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> weigh_alignments_by_matches(TeamEstimate<Pose> estimate, const RunParams& params,
                                               const Progress& progress) {
  if (choose_alignment_by_matches(estimate.joint, estimate.placement, estimate.matches, params.alignment))
    optimize(estimate.joint.team.graph, params.optimizer, progress);
  place_by_matches(estimate.joint, estimate.placement, estimate.matches);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> close_by_loops(TeamEstimate<Pose> estimate, const RunParams& params,
                                  const Progress& progress) {
  close_by_loops(estimate.joint, estimate.placement, estimate.loops, params.optimizer, progress);
  return estimate;
}

bool needs_overlap_search(const Mission& mission, const RunOptions& options) {
  return options.overlap_only || !mission.ranges.empty() || !mission.aoa_measurements.empty() ||
         !mission.matches.empty();
}

template <class Pose>
OverlapStage search_overlaps(const TeamEstimate<Pose>& estimate, const RunParams& params,
                             const RunOptions& options) {
  std::vector<JointGraph<Pose>> alignments{graph_for_covariances(estimate.joint, params.alignment.mixture)};
  const TeamPlacement<Pose>& placement = estimate.placement;
  for (std::size_t k = 0; k < placement.alternatives.size(); ++k) {
    if (overlap_mode(params.overlap) == OverlapMode::kLink) break;
    if (placement.alternative_weights[k] < kMinSearchedWeight) break;
    JointGraph<Pose> alternative = estimate.joint;
    alternative.team.graph.poses = placement.alternatives[k];
    if (!placement.segments.of_segment.empty())
      reweigh_radio_links(alternative, placement, params.alignment.mixture);
    alignments.push_back(graph_for_covariances(alternative, params.alignment.mixture));
  }
  const auto listed = static_cast<std::size_t>(params.overlap.max_listed_candidates);
  return find_overlaps(std::move(alignments), params.overlap,
                       {options.search, options.take_candidates ? 0 : listed,
                        keyframes_of_matches(estimate.joint, estimate.matches), options.take_candidates});
}

template <class Pose>
TeamEstimate<Pose> close_by_matches(TeamEstimate<Pose> estimate, const Mission& mission,
                                    const OverlapStage& overlaps, const RunParams& params,
                                    const RunOptions& options, const Progress& progress) {
  const auto radio = radio_covariance(estimate.joint, estimate.placement, params.alignment);
  std::optional<AoaMatchWeights> angles;
  if (params.matches.angle_weights) angles.emplace(mission, params.matches, params.angles);
  select_matches(estimate.joint, estimate.placement, estimate.matches, overlaps.of_asked, options.pruning,
                 params.matches, angles ? &*angles : nullptr, radio);
  if (radio && params.matches.robust && options.pruning == Pruning::kOn)
    optimise_matches_and_radio(estimate.joint, estimate.matches, estimate.placement, params.matches,
                               params.alignment.mixture, params.optimizer, progress);
  else
    optimise_with_matches(estimate.joint, estimate.matches, params.matches, params.optimizer, progress);
  return estimate;
}

template <class Pose>
TeamEstimate<Pose> test_closures(TeamEstimate<Pose> estimate) {
  test_closures(estimate.joint, FactorSource::kScanLoop, estimate.scans);
  test_closures(estimate.joint, FactorSource::kSequence, estimate.sequences);
  return estimate;
}

#define RADIOSLAM_STAGES(Pose)                                                                             \
  template TeamEstimate<Pose> begin_estimate(const Mission&, const TeamGraph<Pose>*, std::vector<Closure>, \
                                             RadioMeasurements, const RunParams&, const RunOptions&);      \
  template TeamEstimate<Pose> place_robots_by_fixes(TeamEstimate<Pose>, const Mission&, const RunParams&); \
  template TeamEstimate<Pose> align_team(TeamEstimate<Pose>, const Mission&, const RunParams&,             \
                                         const Progress&);                                                 \
  template TeamEstimate<Pose> close_by_fingerprints(TeamEstimate<Pose>, const RunParams&);                 \
  template TeamEstimate<Pose> close_by_sequences(TeamEstimate<Pose>, const RunParams&);                    \
  template TeamEstimate<Pose> optimise_team(TeamEstimate<Pose>, const RunParams&, const Progress&);        \
  template TeamEstimate<Pose> reclassify_fixes(TeamEstimate<Pose>, const RunParams&, const Progress&);     \
  template TeamEstimate<Pose> refine_on_field(TeamEstimate<Pose>, const Mission&, const RunParams&,        \
                                              const Progress&);                                            \
  template TeamEstimate<Pose> correct_range_biases(TeamEstimate<Pose>, const RunParams&, const Progress&); \
  template TeamEstimate<Pose> weigh_alignments_by_matches(TeamEstimate<Pose>, const RunParams&,            \
                                                          const Progress&);                                \
  template TeamEstimate<Pose> close_by_loops(TeamEstimate<Pose>, const RunParams&, const Progress&);       \
  template OverlapStage search_overlaps(const TeamEstimate<Pose>&, const RunParams&, const RunOptions&);   \
  template TeamEstimate<Pose> close_by_matches(TeamEstimate<Pose>, const Mission&, const OverlapStage&,    \
                                               const RunParams&, const RunOptions&, const Progress&);      \
  template TeamEstimate<Pose> test_closures(TeamEstimate<Pose>);
RADIOSLAM_STAGES(SE2)
RADIOSLAM_STAGES(SE3)
#undef RADIOSLAM_STAGES

}  // namespace radioslam

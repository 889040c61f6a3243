#include "radioslam/pipeline/pipeline.hpp"

#include <optional>
#include <utility>

#include "radioslam/joint/scan_closures.hpp"
#include "radioslam/pipeline/recordings_stage.hpp"
#include "radioslam/pipeline/run_results.hpp"
#include "radioslam/pipeline/stage_clock.hpp"
#include "radioslam/pipeline/stages.hpp"

namespace radioslam {
namespace {

/// The whole estimate, stage by stage. `team`: the mission as a factor graph, or null.
template <class Pose>
RunOutput run(const Mission& mission, const TeamGraph<Pose>* team, std::vector<Closure> scans,
              const RunParams& params, const RunOptions& options, const Progress& progress) {
  StageClock timed;
  auto radio = timed("radio", measure_radio, mission, params.radio, progress);
  auto estimate = timed("graph", begin_estimate<Pose>, mission, team, std::move(scans), std::move(radio),
                        params, options);
  if (has_fixes(mission))
    estimate = timed("position fixes", place_robots_by_fixes<Pose>, std::move(estimate), mission, params);
  estimate = timed("team frame", align_team<Pose>, std::move(estimate), mission, params, progress);
  estimate = timed("closures", close_by_fingerprints<Pose>, std::move(estimate), params);
  estimate = timed("sequences", close_by_sequences<Pose>, std::move(estimate), params);
  estimate = timed("optimise", optimise_team<Pose>, std::move(estimate), params, progress);
  if (has_fixes(mission))
    estimate = timed("settle fixes", reclassify_fixes<Pose>, std::move(estimate), params, progress);
  estimate = timed("radio field", refine_on_field<Pose>, std::move(estimate), mission, params, progress);
  estimate = timed("range biases", correct_range_biases<Pose>, std::move(estimate), params, progress);
  if (!estimate.loops.empty())
    estimate = timed("loops", close_by_loops<Pose>, std::move(estimate), params, progress);
  const bool has_matches = !estimate.matches.empty();
  if (has_matches && weighs_matches(params, options))
    estimate = timed("alignment by matches", weigh_alignments_by_matches<Pose>, std::move(estimate), params,
                     progress);
  std::optional<OverlapStage> overlaps;
  if (needs_overlap_search(mission, options))
    overlaps = timed("overlap", search_overlaps<Pose>, estimate, params, options);
  if (has_matches)
    estimate = timed("matches", close_by_matches<Pose>, std::move(estimate), mission, *overlaps, params,
                     options, progress);
  estimate = test_closures(std::move(estimate));
  RunResult result = describe_run(mission, estimate, std::move(overlaps), params, options, timed);
  return {std::move(result), std::move(estimate.joint.team.graph)};
}

RunOutput run_for_dimension(const Mission& mission, std::vector<Closure> scans, const RunParams& params,
                            const RunOptions& options, const Progress& progress) {
  return mission.dimension == 2 ? run<SE2>(mission, nullptr, std::move(scans), params, options, progress)
                                : run<SE3>(mission, nullptr, std::move(scans), params, options, progress);
}

}  // namespace

RunOutput run_pipeline(Mission mission, const RunParams& params, const RunOptions& options,
                       const Progress& progress) {
  if (!has_raw_recordings(mission)) return run_for_dimension(mission, {}, params, options, progress);
  MeasuredRecordings measured = measure_recordings(mission, params, progress);
  RunOutput output =
      run_for_dimension(mission, closures_of_scans(measured.scans.closures), params, options, progress);
  add_recording_results(output.result, std::move(measured), mission, params, options);
  return output;
}

template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options, const Progress& progress) {
  return run(mission, &team, {}, params, options, progress);
}

template RunOutput run_pipeline(const Mission&, const TeamGraph<SE2>&, const RunParams&, const RunOptions&,
                                const Progress&);
template RunOutput run_pipeline(const Mission&, const TeamGraph<SE3>&, const RunParams&, const RunOptions&,
                                const Progress&);

}  // namespace radioslam

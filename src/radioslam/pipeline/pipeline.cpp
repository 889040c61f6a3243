#include "radioslam/pipeline/pipeline.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/closures/closure_admission.hpp"
#include "radioslam/joint/closures/loop_stage.hpp"
#include "radioslam/joint/closures/radio_alignment_choice.hpp"
#include "radioslam/joint/joint_graph_from_file.hpp"
#include "radioslam/joint/known_access_points.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/places/place_recognition.hpp"
#include "radioslam/joint/position_fixes/component_placement.hpp"
#include "radioslam/joint/team_continuation.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/pipeline/run_results.hpp"
#include "radioslam/radio/captures/csi_aoa.hpp"
#include "radioslam/radio/captures/csi_stage.hpp"

namespace radioslam {
namespace {

void count_scans(RunResult& result, const MeasuredScans& scans) {
  result.counts["scans"] = static_cast<double>(scans.scans);
  result.counts["scans_registered"] = static_cast<double>(scans.registered);
  result.counts["scans_of_few_points"] = static_cast<double>(scans.too_few);
  result.counts["scans_lost"] = static_cast<double>(scans.lost);
  result.counts["scan_closures_accepted"] =
      static_cast<double>(std::count_if(result.closures.begin(), result.closures.end(), [](const auto& c) {
        return c.kind == ClosureKind::kLidar && c.status == ClosureStatus::kAccepted;
      }));
}

void count_places(RunResult& result, const PlaceCounts& places) {
  if (places.pairs == 0) return;
  const auto count = [&](const char* key, std::size_t of) { result.counts[key] = static_cast<double>(of); };
  count("place_pairs", places.pairs);
  count("place_pairs_allowed", places.allowed);
  count("descriptor_pairs", places.compared);
  count("descriptor_bytes", places.bytes.descriptors);
  count("descriptor_bytes_all", places.bytes_all.descriptors);
  count("scan_bytes", places.bytes.scans);
  count("scan_bytes_all", places.bytes_all.scans);
  count("registrations_proposed", places.proposed);
  count("registrations", places.registrations);
  count("registrations_verified", places.verified);
}

bool has_scans(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty(); });
}

bool has_captures(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return robot.csi.has_value(); });
}

/// With the angles measured from captures beside those that were recorded.
void add_angles(Mission& mission, const std::vector<AoaMeasurement>& measured) {
  mission.aoa_measurements.insert(mission.aoa_measurements.end(), measured.begin(), measured.end());
  std::stable_sort(mission.aoa_measurements.begin(), mission.aoa_measurements.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
}

bool is_not_empty(const MeasuredCsi& csi) { return !csi.aoa_measurements.empty() || !csi.notes.empty(); }

/// Adds the results of these recordings to those of a run on the same mission.
void add_recording_results(RunResult& result, const MeasuredScans& scans, MeasuredCsi csi) {
  if (scans.scans > 0) count_scans(result, scans);
  if (is_not_empty(csi)) result.counts["aoa_measurements"] = static_cast<double>(csi.aoa_measurements.size());
  result.notes.insert(result.notes.end(), scans.notes.begin(), scans.notes.end());
  for (auto& note : csi.notes) result.notes.push_back(std::move(note));
  add_estimated_azimuths(csi.profiles, result.robots);
  result.aoa_measurements = std::move(csi.profiles);
}

template <class Pose>
KnownStarts starts_of(const RunSetup& run, const TeamEstimate<Pose>& team) {
  return starts_with_fixes<Pose>(team.measured.starts, run.mission, team.judgement.fixes);
}

/// Robots with position fixes, in the common frame.
template <class Pose>
void align_by_fixes(const RunSetup& run, TeamEstimate<Pose>& team) {
  team.judgement.fixes = place_by_fixes(team.joint, run.mission, run.params.fixes, run.params.optimizer);
}

template <class Pose>
void align_by_links_or_fingerprints(const RunSetup& run, TeamEstimate<Pose>& team,
                                    const TeamEstimate<Pose>* before, AlignmentSearch search) {
  std::optional<TeamAlignment<Pose>> known;
  if (before && !before->alignment.segments.of_segment.empty()) {
    carry_values(before->joint, team.joint);
    known = carried_alignment(*before, team.joint);
  }
  team.alignment =
      has_radio_links(team.joint)
          ? align_by_links(team.joint, run.params.alignment, run.progress, known ? &*known : nullptr, search)
          : align_robots_by_fingerprints(team.joint, run.mission, starts_of(run, team), run.radio,
                                         run.params.team_frame, run.params.field, run.progress);
  place_components_by_fixes(team.joint, team.judgement.fixes, run.params.fixes, team.alignment);
  constrain_by_fixes(team.joint, team.judgement.fixes, team.alignment);
}

template <class Pose>
void close_by_fingerprints(const RunSetup& run, TeamEstimate<Pose>& team) {
  team.measured.fingerprint_closures = propose_fingerprint_closures(
      starts_of(run, team), run.radio, fingerprint_places(team.joint, run.radio),
      run.params.radio.distance_model.max_trusted_path_m, run.params.team_frame, run.params.closure);
  add_fingerprint_closures(team.joint, run.radio, team.measured.fingerprint_closures);
}

/// Makes closures that came late part of the team.
template <class Pose>
void add_found(const RunSetup& run, TeamEstimate<Pose>& team, const std::vector<VerifiedClosure>& found) {
  auto& closures = team.measured.closures;
  auto& judgements = team.judgement.closures;
  for (const VerifiedClosure& closure : found)
    if (closure.judgement.status == ClosureStatus::kAccepted)
      append({closure}, closures.loops, judgements.loops);
    else
      append({closure}, closures.scans, judgements.scans);
  hang_on_keyframes(team.joint, run.mission, closures.loops);
}

/// Moves the team to the alignment that radio links and groups of consistent closures support best.
template <class Pose>
void choose_alignment(const RunSetup& run, TeamEstimate<Pose>& team) {
  if (choose_alignment_by_loops(team.joint, team.alignment, team.measured.closures.loops,
                                run.params.alignment, run.params.consistency, run.maps))
    optimize(team.joint.team.graph, run.params.optimizer, run.progress);
}

bool needs_overlap_search(const RunSetup& run) {
  return run.options.overlap_only || !run.mission.ranges.empty() || !run.mission.aoa_measurements.empty() ||
         !run.mission.matches.empty();
}

/// Keyframe pairs of different robots whose views can overlap, in any of the likely alignments.
template <class Pose>
OverlapStage search_overlaps(const RunSetup& run, const TeamEstimate<Pose>& team,
                             const OverlapStageParams& overlap, const OverlapRequest& request) {
  const MixtureParams& mixture = run.params.alignment.mixture;
  std::vector<JointGraph<Pose>> alignments{graph_for_covariances(team.joint, mixture)};
  const TeamAlignment<Pose>& alignment = team.alignment;
  for (std::size_t k = 0; k < alignment.alternatives.size(); ++k) {
    if (overlap_mode(overlap) == OverlapMode::kLink) break;
    if (alignment.alternative_weights[k] < kMinSearchedWeight) break;
    JointGraph<Pose> alternative = team.joint;
    alternative.team.graph.poses = alignment.alternatives[k];
    if (!alignment.segments.of_segment.empty()) reweigh_radio_links(alternative, alignment, mixture);
    alignments.push_back(graph_for_covariances(alternative, mixture));
  }
  for (JointGraph<Pose>& joint : alignments) leave_out_untied_poses(joint, alignment);
  return find_overlaps(std::move(alignments), overlap, request);
}

/// The pairs that a run lists, and those of matches.
template <class Pose>
OverlapStage list_overlaps(const RunSetup& run, const TeamEstimate<Pose>& team) {
  const auto listed = static_cast<std::size_t>(run.params.overlap.max_listed_candidates);
  return search_overlaps(
      run, team, run.params.overlap,
      {run.options.search, run.options.take_candidates || !run.options.lists_overlaps ? 0 : listed,
       keyframes_of(team.joint, team.measured.closures.loops), run.options.take_candidates});
}

bool compares_scans(const RunSetup& run, const MeasuredScans& scans) {
  return run.params.places.enabled && !run.options.overlap_only && has_comparable_scans(scans);
}

/// Closures between robots by their scans, where the team as estimated so far may have met. `round`: from 0.
template <class Pose>
RecognisedPlaces find_places(const RunSetup& run, const TeamEstimate<Pose>& team, const MeasuredScans& scans,
                             const TeamDescriptors& descriptors, int round = 0,
                             const RecognisedPlaces& before = {}) {
  if (!compares_scans(run, scans)) return {};
  std::vector<CandidateList::Group> allowed;
  PlaceInput<Pose> input{team,
                         run.mission,
                         scans,
                         descriptors,
                         nullptr,
                         before.attempts,
                         before.exchange,
                         budget_of_round(run.params.places, run.options.verifications,
                                         run.mission.robots.size(), round, before.attempts.size())};
  if (run.options.pruning == Pruning::kOn) {
    const auto keep = [&](const CandidateList::Group& group, const auto&) { allowed.push_back(group); };
    OverlapStageParams overlap = run.params.overlap;
    double& shared_view = overlap.overlap.min_shared_view;
    shared_view = std::max(shared_view, run.params.places.min_shared_view);
    run.timed("overlap", search_overlaps<Pose>, run, team, overlap,
              OverlapRequest{run.options.search, 0, {}, keep});
    input.allowed = &allowed;
  }
  return run.timed("places", recognise_places<Pose>, input, run.params.places, run.params.scans,
                   run.params.alignment, run.progress);
}

/// What radio, overlaps and scans say of the team's closures. Without pruning, nothing; closures then show
/// what they do on their own.
template <class Pose>
ClosureEvidence<Pose> evidence_of(const RunSetup& run, const TeamEstimate<Pose>& team,
                                  const std::optional<OverlapStage>& overlaps) {
  const RunParams& params = run.params;
  const bool is_pruned = run.options.pruning == Pruning::kOn;
  ClosureEvidence<Pose> evidence;
  evidence.consistency = params.consistency;
  std::optional<AoaMatchWeights> angles;
  if (params.matches.angle_weights) angles.emplace(run.mission, params.matches, params.angles);
  if (is_pruned && params.matches.robust) {
    evidence.radio = radio_covariance(team.joint, team.alignment, params.alignment);
    evidence.maps = run.maps;
  }
  if (has_radio_links(team.joint)) evidence.links = &params.alignment.mixture;
  evidence.admissions = admit_closures(team.joint, team.alignment, team.measured.closures.loops,
                                       is_pruned && overlaps ? &overlaps->of_asked : nullptr, evidence.radio,
                                       angles ? &*angles : nullptr);
  return evidence;
}

/// Decides which closures hold, and solves the team with them.
template <class Pose>
void close_team(const RunSetup& run, TeamEstimate<Pose>& team, const std::optional<OverlapStage>& overlaps) {
  const std::vector<Closure>& closures = team.measured.closures.loops;
  std::vector<ClosureJudgement>& judgements = team.judgement.closures.loops;
  const ClosureEvidence<Pose> evidence = evidence_of(run, team, overlaps);
  if (run.params.matches.robust)
    team.judgement.loop_choice = close_by_loops(team.joint, team.alignment, closures, judgements, evidence,
                                                run.params.optimizer, run.progress);
  else
    close_by_all(team.joint, closures, evidence.admissions, judgements, run.params.optimizer, run.progress);
}

}  // namespace

template <class Pose>
TeamEstimate<Pose> build_team(const RunSetup& run, const TeamGraph<Pose>* graph, const MeasuredScans& scans) {
  TeamEstimate<Pose> team;
  auto& closures = team.measured.closures;
  auto& judgements = team.judgement.closures;
  const std::vector<VerifiedClosure> of_scans = closures_of_scans(scans.closures);
  append(of_scans, closures.scans, judgements.scans);
  team.joint = graph ? joint_graph_of(*graph, run.mission)
                     : build_joint_graph<Pose>(run.mission, run.params.keyframe, run.params.graph);
  team.measured.starts = known_starts(run.mission);
  if (graph)
    closures.loops = closures_of(*graph, team.joint);
  else if (!run.options.overlap_only)
    closures.loops = closures_of_matches(run.mission);
  hang_on_keyframes(team.joint, run.mission, closures.loops);
  judgements.loops.resize(closures.loops.size());
  correct_by_scans(team.joint, run.mission, scans);
  add_scan_closures(team.joint, of_scans);
  add_own_loops(team.joint, closures.loops, run.params.optimizer);
  return team;
}

template <class Pose>
TeamEstimate<Pose> align_team(const RunSetup& run, TeamEstimate<Pose> team, const TeamEstimate<Pose>* before,
                              AlignmentSearch search) {
  const RunParams& params = run.params;
  JointGraph<Pose>& joint = team.joint;
  StageClock& timed = run.timed;
  if (has_fixes(run.mission)) timed("position fixes", align_by_fixes<Pose>, run, team);
  timed("team frame", align_by_links_or_fingerprints<Pose>, run, team, before, search);
  timed("closures", close_by_fingerprints<Pose>, run, team);
  team.measured.sequences = timed(
      "sequences", [&] { return match_sequences(Pose::kDim, run.radio, params.sequence, run.sequences); });
  append(add_sequence_closures(joint, run.radio, team.measured.sequences, params.sequence),
         team.measured.closures.sequences, team.judgement.closures.sequences);
  team.solution =
      timed("optimise", optimize_robustly<Pose>, joint, params.robust, params.optimizer, run.progress);
  if (has_fixes(run.mission))
    timed("reclassify fixes", reclassify_fixes<Pose>, joint, team.judgement.fixes, params.optimizer,
          run.progress);
  team.judgement.range_biases =
      timed("range biases", estimate_range_biases<Pose>, joint, team.alignment, params.range_bias,
            params.alignment.mixture, params.optimizer, run.progress);
  return team;
}

template <class Pose>
JudgedTeam<Pose> judge_closures(const RunSetup& run, TeamEstimate<Pose> aligned,
                                const std::vector<VerifiedClosure>& found) {
  JudgedTeam<Pose> judged{std::move(aligned), std::nullopt};
  TeamEstimate<Pose>& team = judged.team;
  const auto& closures = team.measured.closures;
  auto& judgements = team.judgement.closures;
  add_found(run, team, found);
  const bool has_closures = !closures.loops.empty(), is_pruned = run.options.pruning == Pruning::kOn;
  if (has_closures && is_pruned && run.params.matches.robust)
    run.timed("alignment by closures", choose_alignment<Pose>, run, team);
  const auto search = [&] {
    if (needs_overlap_search(run) && (has_closures || run.options.lists_overlaps))
      judged.overlaps = run.timed("overlap", list_overlaps<Pose>, run, team);
  };
  if (!has_closures || relates_robots(team.alignment)) search();
  const auto frames = team.alignment.component;
  if (has_closures) run.timed("loops", close_team<Pose>, run, team, judged.overlaps);
  if (!judged.overlaps || team.alignment.component != frames) search();
  test_closures(team.joint, FactorSource::kScanLoop, judgements.scans);
  test_closures(team.joint, FactorSource::kSequence, judgements.sequences);
  return judged;
}

namespace {

/// What a run estimates from.
template <class Pose>
struct RunInput {
  const Mission& mission;                  ///< as logs describe it
  const Mission& measured;                 ///< the same with all of its odometry
  const TeamGraph<Pose>* graph = nullptr;  ///< the team as a factor graph
  MeasuredScans scans = {};
  std::vector<VerifiedClosure> places = {};  ///< closures between robots that their scans gave before
};

/// Adds what was found in another round.
void add_places(RecognisedPlaces& places, RecognisedPlaces more) {
  if (places.attempts.empty())
    places = std::move(more);
  else
    places.append(std::move(more));
}

template <class Pose>
struct JudgedPlaces {
  JudgedTeam<Pose> judged;
  RecognisedPlaces places;
};

/// The team aligned, with its closures judged. `places`: what was found before; closures between robots by
/// their scans are searched in at most so many rounds, and `found` are known otherwise.
template <class Pose>
JudgedPlaces<Pose> judge_with_places(const RunSetup& run, const TeamEstimate<Pose>& aligned,
                                     const MeasuredScans& scans, RecognisedPlaces places, int rounds,
                                     const std::vector<VerifiedClosure>& found) {
  TeamDescriptors descriptors;
  if (compares_scans(run, scans))
    descriptors = run.timed("places", describe_places, scans, run.params.places.descriptors,
                            run.params.scans.loops.submap_m);
  add_places(places, find_places(run, aligned, scans, descriptors, 0, places));
  const auto judge = [&] {
    std::vector<VerifiedClosure> all = places.closures;
    all.insert(all.end(), found.begin(), found.end());
    return judge_closures(run, aligned, all);
  };
  auto judged = judge();
  const auto note_judgement = [&] {
    const auto& loops = judged.team.measured.closures.loops;
    if (!loops.empty()) places.note_judgement(loops, judged.team.judgement.closures.loops);
  };
  const auto may_find_more = [&] { return places.has_verified() || places.counts.has_left_out(); };
  for (int round = 1; round < rounds && may_find_more(); ++round) {
    auto& closures = judged.team.measured.closures;
    auto& judgements = judged.team.judgement.closures;
    note_judgement();
    auto more = find_places(run, judged.team, scans, descriptors, round, places);
    const bool has_more = more.has_verified(), has_tried = more.counts.registrations > 0;
    if (!has_more) append(more.closures, closures.scans, judgements.scans);
    places.append(std::move(more));
    if (has_more)
      judged = judge();
    else if (!has_tried || !places.counts.has_left_out())
      break;
  }
  note_judgement();
  return {std::move(judged), std::move(places)};
}

/// The whole estimate.
template <class Pose>
RunOutput run(const RunInput<Pose>& input, const RunParams& params, const RunOptions& options,
              const Progress& progress, StageClock& timed) {
  const Mission& recorded = input.mission;
  const RadioMeasurements radio = timed("radio", measure_radio, recorded, params.radio, progress);
  const auto known = timed("radio fixes", use_known_access_points, recorded, radio, params.access_points);
  const Mission& mission = known.mission ? *known.mission : recorded;
  const MapWitness maps(mission, input.scans);
  const RunSetup run{mission, radio, params, options, progress, timed, &maps};
  auto built = timed("graph", build_team<Pose>, run, input.graph, input.scans);
  auto [judged, places] = judge_with_places(run, align_team(run, std::move(built)), input.scans, {},
                                            params.places.rounds, input.places);
  RunResult result = describe_run(mission, input.measured, input.scans, radio, judged.team,
                                  std::move(judged.overlaps), params, options, timed);
  count_places(result, places.counts);
  add_known_access_points(result, recorded, known.fixes, params.access_points.known);
  places.closures.insert(places.closures.end(), input.places.begin(), input.places.end());
  return {std::move(result), std::move(judged.team.joint.team.graph), std::move(places.closures)};
}

/// Closures of scans that logs say: of each robot, and between robots.
template <class Pose>
void add_logged_closures(const LoggedMission& logged, RunInput<Pose>& input) {
  for (const ScannedClosure& closure : logged.closures) {
    const auto& [i, j, stamp_i, stamp_j] =
        std::tie(closure.robot_i, closure.robot_j, closure.stamp_i, closure.stamp_j);
    if (i == j)
      input.scans.closures.push_back({i, stamp_i, stamp_j, loop_of(closure)});
    else
      input.places.push_back(closure_of_scan(i, stamp_i, j, stamp_j, loop_of(closure)));
  }
}

RunOutput estimate_all(const LoggedMission& logged, const Mission& measured, const MeasuredScans& scans,
                       const RunParams& params, const RunOptions& options, const Progress& progress,
                       StageClock& timed) {
  const auto of_dimension = [&]<class Pose>(RunInput<Pose> input) {
    add_logged_closures(logged, input);
    return run(input, params, options, progress, timed);
  };
  RunOutput output = logged.mission.dimension == 2
                         ? of_dimension(RunInput<SE2>{logged.mission, measured, nullptr, scans})
                         : of_dimension(RunInput<SE3>{logged.mission, measured, nullptr, scans});
  auto& notes = output.result.notes;
  notes.insert(notes.begin(), logged.notes.begin(), logged.notes.end());
  return output;
}

/// What was estimated before, with odometry and links since; nothing if it is of another team.
template <class Pose>
std::optional<TeamSolution<Pose>> extend(const RunSetup& run, const TeamSolution<Pose>& last) {
  constexpr int kReweighings = 2;
  auto team =
      extended(last.team, build_joint_graph<Pose>(run.mission, run.params.keyframe, run.params.graph));
  if (!team) return std::nullopt;
  const bool has_links = has_radio_links(team->joint) && !team->alignment.segments.of_segment.empty();
  for (int round = 0; round < kReweighings; ++round) {
    if (has_links) reweigh_radio_links(team->joint, team->alignment, run.params.alignment.mixture);
    team->solution = optimize(team->joint.team.graph, run.params.optimizer, run.progress);
    if (!has_links) break;
  }
  return TeamSolution<Pose>{*std::move(team), last.radio, last.places, Effort::kExtend, last.weight_by_links};
}

/// Its fingerprints joined from the least similarity that closures and sequences ask for.
RadioMeasurements joined(RadioMeasurements radio, int dimension, const RunParams& params) {
  double minimum = least_near_similarity(radio, params.closure).value_or(1);
  if (dimension == 2 && params.sequence.enabled)
    minimum = std::min(minimum, params.sequence.closure.min_similarity);
  const bool is_layout = params.radio.measure == params.radio.layout_measure;
  radio.near_similarity = radio.near_similarity.joined(std::max(minimum, kAnySimilarity));
  if (is_layout) radio.layout_similarity = radio.near_similarity;
  return radio;
}

}  // namespace

template <class Pose>
TeamSolution<Pose> estimate(const TeamView& view, const TeamSolution<Pose>* last, Effort effort,
                            const RunParams& params, const RunOptions& options, const Progress& progress) {
  const Mission& recorded = view.logged.mission;
  const bool continues = last && are_same_robots(recorded.robots, last->team.joint.robots);
  StageClock timed;
  RunInput<Pose> input{recorded, recorded, nullptr, view.scans};
  add_logged_closures(view.logged, input);
  if (continues && effort == Effort::kExtend) {
    const RunSetup run{recorded, *last->radio, params, options, progress, timed, nullptr};
    if (auto extended = extend(run, *last)) return *std::move(extended);
  }
  std::optional<RadioMeasurements> continued;
  if (continues) continued = continue_radio(*last->radio, recorded, params.radio);
  std::optional<EarlierSequences> sequences;
  if (continued) sequences.emplace(EarlierSequences{*last->radio, last->team.measured.sequences});
  const auto radio = std::make_shared<const RadioMeasurements>(
      continued ? *std::move(continued)
                : joined(measure_radio(recorded, params.radio, progress), recorded.dimension, params));
  const auto known = use_known_access_points(recorded, *radio, params.access_points);
  const Mission& mission = known.mission ? *known.mission : recorded;
  const MapWitness maps(mission, input.scans);
  const RunSetup run{mission,  *radio, params, options,
                     progress, timed,  &maps,  sequences ? &*sequences : nullptr};
  const bool searches = !last || effort == Effort::kAlign;
  auto aligned =
      align_team<Pose>(run, build_team<Pose>(run, nullptr, input.scans), last ? &last->team : nullptr,
                       searches ? AlignmentSearch::kAll : AlignmentSearch::kNearKnown);
  auto judged = judge_with_places(run, aligned, input.scans, continues ? *last->places : RecognisedPlaces{},
                                  params.places.rounds, input.places);
  return {std::move(judged.judged.team), radio,
          std::make_shared<const RecognisedPlaces>(std::move(judged.places)),
          searches ? Effort::kAlign : Effort::kJudge, aligned.alignment.weight};
}

MeasuredRecordings measure_recordings(const Mission& recorded, const RunParams& params,
                                      const RunOptions& options, StageClock& timed, const Progress& progress,
                                      std::vector<std::optional<TrackedScans>> tracked) {
  MeasuredRecordings measured;
  if (has_scans(recorded)) {
    const bool is_compared = params.places.enabled && !options.overlap_only && recorded.robots.size() > 1;
    measured.scans = timed("scans", measure_scans, recorded, params.scans, params.keyframe, progress,
                           is_compared ? ScansOfRecorded::kForPlaces : ScansOfRecorded::kIgnored,
                           params.places.descriptors, std::move(tracked));
    measured.mission = with_odometry(recorded, measured.scans, params.keyframe);
  }
  if (has_captures(recorded)) {
    if (!measured.mission) measured.mission = recorded;
    measured.csi = timed("angles", measure_csi, *measured.mission, params.csi, progress);
    add_angles(*measured.mission, measured.csi.aoa_measurements);
  }
  return measured;
}

RunOutput run_pipeline(const Mission& recorded, const RunParams& params, const RunOptions& options,
                       const Progress& progress) {
  StageClock timed;
  const MeasuredRecordings recordings = measure_recordings(recorded, params, options, timed, progress);
  return run_pipeline(recorded, recordings, params, options, std::move(timed), progress);
}

RunOutput run_pipeline(const Mission& recorded, const MeasuredRecordings& recordings, const RunParams& params,
                       const RunOptions& options, StageClock timed, const Progress& progress) {
  const Mission& measured = recordings.mission ? *recordings.mission : recorded;
  const LoggedMission logged = timed("records", by_logs, measured, params.keyframe);
  RunOutput output = estimate_all(logged, measured, recordings.scans, params, options, progress, timed);
  add_recording_results(output.result, recordings.scans, recordings.csi);
  output.result.timings = timed.timings();
  return output;
}

RunOutput run_pipeline(const LoggedMission& logged, const RunParams& params, const RunOptions& options,
                       const Progress& progress) {
  StageClock timed;
  RunOutput output = estimate_all(logged, logged.mission, {}, params, options, progress, timed);
  output.result.timings = timed.timings();
  return output;
}

template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options, const Progress& progress) {
  StageClock timed;
  RunOutput output = run(RunInput<Pose>{mission, mission, &team}, params, options, progress, timed);
  output.result.timings = timed.timings();
  return output;
}

#define RADIOSLAM_PIPELINE(Pose)                                                                             \
  template RunOutput run_pipeline(const Mission&, const TeamGraph<Pose>&, const RunParams&,                  \
                                  const RunOptions&, const Progress&);                                       \
  template TeamEstimate<Pose> build_team(const RunSetup&, const TeamGraph<Pose>*, const MeasuredScans&);     \
  template TeamEstimate<Pose> align_team(const RunSetup&, TeamEstimate<Pose>, const TeamEstimate<Pose>*,     \
                                         AlignmentSearch);                                                   \
  template JudgedTeam<Pose> judge_closures(const RunSetup&, TeamEstimate<Pose>,                              \
                                           const std::vector<VerifiedClosure>&);                             \
  template TeamSolution<Pose> estimate(const TeamView&, const TeamSolution<Pose>*, Effort, const RunParams&, \
                                       const RunOptions&, const Progress&);
RADIOSLAM_PIPELINE(SE2)
RADIOSLAM_PIPELINE(SE3)
#undef RADIOSLAM_PIPELINE

}  // namespace radioslam

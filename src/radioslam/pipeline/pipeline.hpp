// Offline pipeline: estimates the joint trajectory of a team from its recorded mission.
//
//   measure    scans give odometry and loop closures of each robot, captures angles, WiFi scans fingerprints
//   record     what every robot's log says of all that
//   build      the joint graph: odometry, known starts, radio links, each robot's own closures
//   align      all robots in one frame, and the team optimized there
//   judge      closures between robots: propose where views overlap, select those that hold, solve; with
//              closures found since, from the same aligned team again
//   describe   trajectories, uncertainty, outcomes, notes
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/joint/places/map_witness.hpp"
#include "radioslam/joint/places/place_recognition.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/radio/captures/csi_stage.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/results/stage_clock.hpp"

namespace radioslam {

/// Results of a run and its final graph.
struct RunOutput {
  RunResult result;
  std::variant<PoseGraph2, PoseGraph3> graph;
  std::vector<VerifiedClosure> places;  ///< found between robots by their scans, as verified
};

/// What raw recordings measure: laser scans the odometry and loop closures of each robot, CSI captures angles
/// of arrival.
struct MeasuredRecordings {
  /// As recorded, with the odometry of its scans and the angles of its captures; nothing if it has neither.
  std::optional<Mission> mission;
  MeasuredScans scans;
  MeasuredCsi csi;
};

/// `tracked`: per robot its scans, where they have been tracked already.
MeasuredRecordings measure_recordings(const Mission& recorded, const RunParams& params,
                                      const RunOptions& options, StageClock& timed,
                                      const Progress& progress = {},
                                      std::vector<std::optional<TrackedScans>> tracked = {});

/// Estimates the joint trajectory of the team from what its robots' logs say of the mission, and from scans.
/// Deterministic: the same mission and parameters give identical numbers for any number of threads.
/// RunResult::parameters is left for the caller to fill.
RunOutput run_pipeline(const Mission& recorded, const RunParams& params, const RunOptions& options = {},
                       const Progress& progress = {});

/// The same from what its recordings measured, which several runs may share. `timed`: the stages so far.
RunOutput run_pipeline(const Mission& recorded, const MeasuredRecordings& recordings, const RunParams& params,
                       const RunOptions& options = {}, StageClock timed = {}, const Progress& progress = {});

/// The same from logs alone. Trajectories have the same bytes as those of the mission whose logs these are,
/// if it has no scans and its robots are in the order of mission_of().
RunOutput run_pipeline(const LoggedMission& logged, const RunParams& params, const RunOptions& options = {},
                       const Progress& progress = {});

/// The same for a team given as a factor graph; `mission` contains its robots and no other measurements.
template <class Pose>
RunOutput run_pipeline(const Mission& mission, const TeamGraph<Pose>& team, const RunParams& params,
                       const RunOptions& options = {}, const Progress& progress = {});

/// A run under way: what it is made from, and the wall time of its stages so far.
struct RunSetup {
  const Mission& mission;  ///< with the odometry and angles of its raw recordings
  const RadioMeasurements& radio;
  const RunParams& params;
  const RunOptions& options;
  const Progress& progress;
  StageClock& timed;
  const MapWitness* maps = nullptr;  ///< what scans say of closures between robots; null: none are asked
  const EarlierSequences* sequences = nullptr;  ///< matched before; null: none
};

/// The joint graph of the mission, or of `graph` where the team comes as one, without any relation of the
/// robots that is not measured directly. `scans`: closures of their scans.
template <class Pose>
TeamEstimate<Pose> build_team(const RunSetup& run, const TeamGraph<Pose>* graph, const MeasuredScans& scans);

/// All robots in one frame: by position fixes, by radio links if there are any, else by fingerprints;
/// optimized with all but the closures that are judged. `before`: the estimate so far, or null; alignments by
/// links are searched, or those known before refined.
template <class Pose>
TeamEstimate<Pose> align_team(const RunSetup& run, TeamEstimate<Pose> team,
                              const TeamEstimate<Pose>* before = nullptr,
                              AlignmentSearch search = AlignmentSearch::kAll);

template <class Pose>
struct JudgedTeam {
  TeamEstimate<Pose> team;               ///< its closures are judged
  std::optional<OverlapStage> overlaps;  ///< nothing if no pairs were searched for
};

/// The aligned team with those closures that hold: its own, and `found`, all that came later. These lie
/// between any two stamps that have odometry or, in a graph file, a pose.
template <class Pose>
JudgedTeam<Pose> judge_closures(const RunSetup& run, TeamEstimate<Pose> aligned,
                                const std::vector<VerifiedClosure>& found = {});

/// How much of an estimate is made again. Each does all of what those before it do.
enum class Effort {
  kExtend,  ///< odometry and links since, at the alignment and with the closures found before
  kJudge,   ///< closures, biases, fixes, fingerprints; alignments by links near those known
  kAlign,   ///< all alignments are searched
};

/// What is known of a team at one time.
struct TeamView {
  const LoggedMission& logged;
  const MeasuredScans& scans;  ///< of its keyframes so far, with the closures of each robot
};

/// An estimate of the team from what is known at one time, and what the next one starts from.
template <class Pose>
struct TeamSolution {
  TeamEstimate<Pose> team;
  std::shared_ptr<const RadioMeasurements> radio;
  std::shared_ptr<const RecognisedPlaces> places;
  Effort effort = Effort::kAlign;  ///< that it took
  double weight_by_links = 1;      ///< of the alignment, before closures chose among alternatives
};

/// Estimates the team from the view, and from what was estimated of the same team when less was known; null:
/// nothing. More effort than asked for where the last estimate is of other robots. Deterministic, and for any
/// number of threads the same.
template <class Pose>
TeamSolution<Pose> estimate(const TeamView& view, const TeamSolution<Pose>* last, Effort effort,
                            const RunParams& params, const RunOptions& options = {},
                            const Progress& progress = {});

}  // namespace radioslam

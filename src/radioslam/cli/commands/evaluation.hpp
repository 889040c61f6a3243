// Evaluation against ground truth: notes, dead reckoning as a baseline, closures of a run, text output.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// One note for each robot that is not in the frame of the first component.
std::vector<std::string> frame_notes(const std::vector<EstimatedTrajectory>& robots,
                                     const std::vector<Component>& components,
                                     const std::vector<std::string>& unplaced);

/// Trajectories from odometry alone, beginning at the known starts; empty unless every start is known.
std::vector<EstimatedTrajectory> dead_reckoning(const Mission& mission);

/// The names of robots that have an `id`.
std::vector<std::string> names_of(const auto& robots) {
  std::vector<std::string> names;
  for (const auto& robot : robots) names.push_back(robot.id);
  return names;
}

/// A line per kind of note (results/note_groups.hpp).
std::string notes_text(const std::vector<std::string>& notes, const std::vector<std::string>& robots);

/// Table of position errors per robot and for the team, and the relative error.
std::string metrics_table(const TeamMetrics& metrics);

/// What of a mission its closures are compared with the truth by: links, matches, and the antennas of the
/// robots' cards, without recordings.
Mission without_recordings(const Mission& mission);

/// The run's closures against the truth, by their measurements.
ClosuresByKind compare_closures_with_truth(const RunResult& result, const Mission& mission,
                                           const Truth& truth, const FileLoops& file);

/// A line per kind of closure.
std::string closures_by_kind_text(const ClosuresByKind& closures);

}  // namespace radioslam::cli

// Input of run, prune and evaluate: a mission folder, or a team's factor graph: one file (.g2o, .pyfg or
// .jrl, optionally .zst), a folder of g2o files, or several of these.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/records/logs_of_mission.hpp"

namespace radioslam::cli {

struct MissionInput {
  Mission mission;  ///< for a graph: its robots with dead reckoning, in the order of their poses
  Truth truth;      ///< for a graph: the ground truth of its file, if it has one
  FileLoops loops;  ///< of a graph, for evaluation
  std::vector<std::uint64_t> pose_ids, point_ids;  ///< of a graph, as in TeamGraphFile
  std::vector<std::string> notes;                  ///< on what of a graph's file was left out
  std::variant<std::monostate, TeamGraph<SE2>, TeamGraph<SE3>> graph;
  std::optional<std::vector<ScannedClosure>>
      logged;  ///< closures of scans; nothing where the input is no log

  bool is_recorded() const { return std::holds_alternative<std::monostate>(graph) && !logged; }
};

/// What each robot of the mission would have said, from what its recordings measured. `places`: closures
/// between robots by their scans.
MissionLogs logs_of_recordings(const Mission& recorded, const MeasuredRecordings& recordings,
                               const RunParams& params, const std::vector<VerifiedClosure>& places = {});

/// Reads one path, several g2o files, or logs of robots. Refuses stated starts to be used where the input
/// states none, or is a mission folder, which always uses them.
MissionInput read_input(const std::vector<std::string>& paths, StatedStarts starts = StatedStarts::kIgnored);

/// Calls run_pipeline with the mission, its logs or the graph. `log_folder`: where each robot of a recorded
/// mission gets a file of what it would have said, `<robot>.rslog`; empty: nowhere.
/// `tracked`: scans that have been tracked already.
RunOutput run_input(MissionInput input, const RunParams& params, const RunOptions& options,
                    const Progress& progress, const std::filesystem::path& log_folder = {},
                    std::vector<std::optional<TrackedScans>> tracked = {});

}  // namespace radioslam::cli

// Reads and writes the output folder of a run: <id>.tum per robot, dense/<id>.tum with all its odometry
// samples, candidates.csv, closures.csv, uncertainty.csv, aoa.csv (if angles were estimated from CSI),
// access_points.csv (if access points were located), graph.g2o, summary.json, report.html.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/eval/access_point_errors.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

enum class CandidateTable {
  kOfResult,
  kWritten,  ///< the folder has it already, by a CandidateWriter
};

/// Documents of a run besides its result. Empty texts are not written; null metrics are omitted.
struct RunDocuments {
  nlohmann::ordered_json metrics = nullptr;
  std::string graph_g2o = {};
  std::string report_html = {};
  CandidateTable candidates = CandidateTable::kOfResult;
  nlohmann::ordered_json summary = nullptr;  ///< further members of summary.json
};

/// summary.json: robots, counts, seconds, parameters, team_frame, metrics; and mission, dimension, notes.
nlohmann::ordered_json summary_json(const RunResult& result, const nlohmann::ordered_json& metrics = nullptr);

/// Writes a run's files into an existing folder (see OutputFolder).
void write_run(const std::filesystem::path& folder, const RunResult& result, const RunDocuments& documents);

/// A run as read from its folder.
struct RunFolder {
  std::vector<EstimatedTrajectory> robots;  ///< in the order of the summary; without poses if not placed
  std::vector<Component> components;
  std::vector<std::string> unplaced;
  std::optional<CandidateList> candidates;          ///< nothing if the run did not search for any
  std::vector<ClosureResult> closures;              ///< here and above, robots are indices of `robots`
  std::vector<MeasuredAoaResult> aoa_measurements;  ///< from CSI: stamps and paths only
  std::vector<LocatedAccessPoint> access_points;
  nlohmann::ordered_json summary;  ///< null if there is no summary.json
};

/// Reads a run's folder; every table is optional. Without summary.json, the robots are those with a .tum
/// file, sorted by name. A run that searched for candidates and found none has counts.candidates in its
/// summary; without it, an empty candidates.csv means that there was no search. Errors are InputErrors.
RunFolder read_run(const std::filesystem::path& folder);

/// The robot at all of its odometry samples, from a run's folder; nothing if it is not there.
std::optional<Trajectory<SE3>> read_dense(const std::filesystem::path& folder, const std::string& robot);

/// Parses JSON; refuses invalid JSON, with its line.
nlohmann::ordered_json read_json(const Text& text);

}  // namespace radioslam

// A run's folder: <id>.tum per robot, dense/<id>.tum with its whole odometry, candidates.csv, closures.csv,
// aoa.csv where directions were measured, access_points.csv where some were placed, graph.g2o, summary.json,
// report.html.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// What a run's folder holds beside the result; an empty text is not written, null metrics are left out.
struct RunDocuments {
  nlohmann::ordered_json metrics = nullptr;
  std::string graph_g2o;
  std::string report_html;
};

/// summary.json: robots, counts, seconds, parameters, team_frame, metrics; and mission, dimension, notes.
nlohmann::ordered_json summary_json(const RunResult& result, const nlohmann::ordered_json& metrics = nullptr);

/// Writes a run's files into an existing folder (see OutputFolder).
void write_run(const std::filesystem::path& folder, const RunResult& result, const RunDocuments& documents);

/// A run as its folder tells it.
struct RunFolder {
  std::vector<EstimatedTrajectory> robots;  ///< in the summary's order; without poses if not placed
  std::vector<Component> components;
  std::vector<std::string> unplaced;
  std::optional<std::vector<CandidateResult>> candidates;  ///< nothing: the run did not look for any
  std::vector<ClosureResult> closures;                     ///< robots index `robots`, here and above
  nlohmann::ordered_json summary;                          ///< null where there is no summary.json
};

/// Reads a run's folder; every table is optional. Without summary.json the robots are those with a .tum
/// file, by name. A run that looked for candidates and kept none has counts.candidates in its summary;
/// without it, a candidates.csv without rows says nothing. Refusals are InputErrors.
RunFolder read_run(const std::filesystem::path& folder);

/// Parses JSON; refuses what is none, with its line.
nlohmann::ordered_json read_json(const Text& text);

}  // namespace radioslam

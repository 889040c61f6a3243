// Tables I to III of Liu et al., Collaborative Radio SLAM for Multiple Robots based on WiFi Fingerprint
// Similarity, reproduced in simulated car parks or on recorded missions: their algorithm 1 over its
// thresholds and measures, compared with the defaults, which have no threshold to tune, on the same missions.
//
// As published: windows of 5 s at any speed; equal weights for all samples of the distance model; a pair
// within a robot is used after 100 m of path if d(s) < nu_s, one between robots if d(s) < nu_p; every pair
// weighs 1 / sigma(s)^2 in least squares, with odometry and known starts. No robust loss, sequence closures,
// evidence temperature, RSSI offsets or variable for constant odometry drift. Not published, and chosen here:
// the odometry's covariances are the white part of what the mission states, a window over similarity needs 30
// samples, and sigma is at least 1 m.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/study/fingerprints/study_missions.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// A row's measure: its name in the table, and in `radio.measure`.
struct FingerprintMeasure {
  const char* label;
  const char* measure;
  double sigma_detection;  ///< sigma_tau, for measures that use it
};

/// Those of the tables, then the others; measures of one name are neighbours.
inline constexpr std::size_t kPublishedMeasures = 5;
inline constexpr std::array<FingerprintMeasure, 8> kFingerprintMeasures{{{"cosine", "cosine", 1},
                                                                         {"Gaussian", "gaussian", 1},
                                                                         {"σ_τ = 1", "detection", 1},
                                                                         {"σ_τ = 4", "detection", 4},
                                                                         {"σ_τ = 8", "detection", 8},
                                                                         {"slide", "slide", 1},
                                                                         {"mended", "mended", 1},
                                                                         {"Sørensen", "sorensen", 1}}};

/// One measure at one pair of thresholds. Errors: position, RMSE after one alignment of the team.
struct FingerprintCell {
  std::size_t measure = 0;                        ///< index into kFingerprintMeasures
  double nu_within_m = 0;                         ///< nu_s
  double nu_between_m = 0;                        ///< nu_p; 0: every robot on its own
  std::vector<std::optional<double>> ate_m = {};  ///< by mission
};

struct FingerprintTables {
  std::vector<StudyMission> missions;  ///< with their names alone
  std::vector<FingerprintCell> cells;
  std::vector<std::optional<double>> defaults_ate_m, dead_reckoning_ate_m;  ///< by mission
};

/// Error of algorithm 1 in metres at these thresholds.
std::optional<double> published_algorithm_ate_m(const Mission& mission, const Truth& truth,
                                                const FingerprintCell& cell);

/// The published value of the cell in table I, II or III of the test, 0 or 1; nothing for thresholds not
/// published.
std::optional<double> published_ate_m(std::size_t test, const FingerprintCell& cell);

/// Measures of this name, as indices into kFingerprintMeasures; those of the tables for an empty name, all
/// for "all".
std::vector<std::size_t> fingerprint_measures(const std::string& name);

/// Every cell of the tables with these measures on missions in the plane whose starts are known. Independent
/// of the number of threads. Cost: about a core minute per car park of the default size.
FingerprintTables measure_fingerprint_tables(const std::vector<StudyMission>& missions,
                                             const std::vector<std::size_t>& measures,
                                             const Progress& progress = {});

/// Means over the missions, next to the published figures.
StudyTable fingerprint_tables_table(const FingerprintTables& tables);

/// Mean of the values that exist.
std::optional<double> mean_of(const std::vector<std::optional<double>>& values);

}  // namespace radioslam

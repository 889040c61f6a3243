// Tables I to III of Liu et al., Collaborative Radio SLAM for Multiple Robots based on WiFi Fingerprint
// Similarity, again: their algorithm 1 in simulated car parks, over its thresholds and measures, and our
// defaults, which have no threshold to tune, on the same missions.
//
// As published: windows of 5 s however far the robot drives in them; samples of the distance model all count
// the same; a pair within a robot takes part after 100 m of way where d(s) < nu_s, one between robots where
// d(s) < nu_p; every one weighs 1 / sigma(s)^2 in least squares, next to odometry and known starts. No loss,
// no sequences, no shares of evidence, no offsets of devices, no variable for the odometry's constant drift.
// What is not published is ours: the odometry's covariances are the white part of what the mission states, a
// window over similarity needs 30 samples, and sigma is at least 1 m.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/sim/carpark.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// A row's measure: its name in the table and in `radio.measure`.
struct FingerprintMeasure {
  const char* label;
  const char* measure;
  double sigma_detection;  ///< sigma_tau, where the measure has it
};

inline constexpr std::array<FingerprintMeasure, 5> kFingerprintMeasures{{{"cosine", "cosine", 1},
                                                                         {"Gaussian", "gaussian", 1},
                                                                         {"σ_τ = 1", "detection", 1},
                                                                         {"σ_τ = 4", "detection", 4},
                                                                         {"σ_τ = 8", "detection", 8}}};

/// One measure at one pair of thresholds. Errors: position, RMSE after one alignment of the team.
struct FingerprintCell {
  std::size_t measure = 0;                        ///< of kFingerprintMeasures
  double nu_within_m = 0;                         ///< nu_s
  double nu_between_m = 0;                        ///< nu_p; 0: every robot alone
  std::vector<std::optional<double>> ate_m = {};  ///< by seed
};

struct FingerprintTables {
  std::uint64_t first_seed = 1;
  std::vector<FingerprintCell> cells;
  std::vector<std::optional<double>> defaults_ate_m, dead_reckoning_ate_m;  ///< by seed
};

/// The error in metres of algorithm 1 at these thresholds.
std::optional<double> published_algorithm_ate_m(const Mission& mission, const Truth& truth,
                                                const FingerprintCell& cell);

/// What the cell says in table I, II or III of the test, 0 or 1; nothing for thresholds not published.
std::optional<double> published_ate_m(std::size_t test, const FingerprintCell& cell);

/// Every cell of the tables on so many missions, whose starts must be known. The same for any number of
/// threads. Cost: about a minute of one core per mission of the default size.
FingerprintTables measure_fingerprint_tables(const CarparkParams& carpark, std::uint64_t first_seed,
                                             int seeds, const Progress& progress = {});

/// Means over the missions beside the published figures.
StudyTable fingerprint_tables_table(const FingerprintTables& tables);

/// Of those that there are.
std::optional<double> mean_of(const std::vector<std::optional<double>>& values);

}  // namespace radioslam

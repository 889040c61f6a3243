// Missions on which studies of fingerprints compare: simulated car parks, or recorded ones with their truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {

struct StudyMission {
  Mission mission;
  Truth truth;
  std::optional<std::uint64_t> seed = {};  ///< of a simulated one
  std::size_t starts_of_truth = 0;         ///< robots whose start take_starts_of_truth() gave

  /// The seed or the mission's name.
  std::string name() const;
};

/// The seeds from `first_seed`.
std::vector<StudyMission> simulated_carparks(const CarparkParams& carpark, std::uint64_t first_seed,
                                             int seeds);

/// "Seed 3", "10 seeds from 3 on", "Mission F8" or "Missions F2, F8".
std::string listed(const std::vector<StudyMission>& missions);

/// What a study of fingerprints needs and this mission lacks, or nothing: fingerprints, odometry, true
/// positions, the plane; "robots/<id>/groundtruth.tum: ..." where it is a file.
std::optional<std::string> lacking(const StudyMission& mission);
/// Gives robots of unknown start the one with which their odometry fits their true positions best, rigidly
/// and in the plane; the odometry then begins at its origin. Robots with fewer than two of these keep none.
void take_starts_of_truth(StudyMission& mission);
/// The robots of unknown start, "a, b"; empty if all are known.
std::string of_unknown_start(const Mission& mission);

/// Names of all similarity measures.
std::vector<std::string> similarity_measures();

}  // namespace radioslam

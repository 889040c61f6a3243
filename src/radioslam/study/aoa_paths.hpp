// Three waves at once, simulated: which of them the profiles find.
//
// A robot drives an arc of a metre and asks another for answers. Plane waves arrive 25 degrees apart, the
// direct one first and strongest, the others up to 6 dB weaker and some tens of nanoseconds later; which of
// the three is direct, where they come from, and their phases are drawn per seed. A path is found where a
// peak that is no ghost lies within 5 degrees.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// What the cards add beside noise.
enum class AoaCards { kIdeal, kDrifting };

/// One run by one profile.
struct AoaPathsRun {
  std::uint64_t seed = 0;
  bool measured = false;           ///< there was an estimate
  int found = 0;                   ///< of the three
  double direct_error_rad = 0;     ///< of the peak nearest to the direct path; half a turn without one
  double strongest_error_rad = 0;  ///< of the strongest peak against the direct path
  int ghosts = 0;                  ///< named
};

struct AoaPathsCell {
  std::string profile;
  AoaCards cards;
  std::vector<AoaPathsRun> runs;  ///< by seed
};

/// Seeds from `first_seed` on, each with ideal and with drifting cards, by bartlett, music and sparse; the
/// same runs for any number of threads. Of `profile` alone where it is given.
std::vector<AoaPathsCell> measure_aoa_paths(int seeds, std::uint64_t first_seed, const ArrivalParams& params,
                                            const Progress& progress, const std::string& profile = "");

StudyTable aoa_paths_table(const std::vector<AoaPathsCell>& cells);

const char* word_for(AoaCards cards);

}  // namespace radioslam

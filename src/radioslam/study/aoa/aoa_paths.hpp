// AoA estimation under multipath: which of three simulated simultaneous plane waves the profiles resolve.
//
// A robot drives an arc of one metre and exchanges packets with another. Plane waves arrive 25 degrees apart,
// the direct one strongest, the others up to 6 dB weaker and some tens of nanoseconds later; their
// directions, phases and which of them is direct are drawn per seed. A path is found if a peak that is not a
// cross term is within 5 degrees.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// Errors that the cards add besides noise.
enum class AoaCards { kIdeal, kDrifting };

/// One run with one profile.
struct AoaPathsRun {
  std::uint64_t seed = 0;
  bool measured = false;           ///< whether there was an estimate
  int found = 0;                   ///< number of the three paths that were found
  double direct_error_rad = 0;     ///< of the peak nearest to the direct path; pi without one
  double strongest_error_rad = 0;  ///< of the strongest peak relative to the direct path
  int cross_terms = 0;             ///< number of peaks marked as cross terms
};

struct AoaPathsCell {
  std::string profile;
  AoaCards cards;
  std::vector<AoaPathsRun> runs;  ///< by seed
};

/// Runs the seeds from `first_seed`, each with ideal and with drifting cards, with profiles bartlett, music
/// and sparse, or only with `profile` if given. Independent of the number of threads.
std::vector<AoaPathsCell> measure_aoa_paths(int seeds, std::uint64_t first_seed, const AoaParams& params,
                                            const Progress& progress, const std::string& profile = "");

StudyTable aoa_paths_table(const std::vector<AoaPathsCell>& cells);

const char* word_for(AoaCards cards);

}  // namespace radioslam

// Sequence closures compared with the truth in simulated car parks: number and accuracy, over the minimum
// similarity of their fingerprints and the length of the windows, the two parameters studied by Dammalapati
// and Hajdarpasic, WiFi Assisted Loop Closure Detection. A closure is right within 3 m and 20 degrees of the
// truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// An accepted closure and its error.
struct SequenceError {
  double distance_m = 0;
  double angle_rad = 0;
  double nees = 0;  ///< squared Mahalanobis distance of the truth; 3 on average for a consistent covariance

  bool right() const;
};

/// All missions at one minimum similarity and one window length.
struct SequenceCell {
  double min_similarity = 0;
  double window_path_m = 0;
  std::size_t missions = 0;
  std::size_t candidates = 0;
  std::vector<SequenceError> accepted;
};

/// Errors of the accepted closures. The truth must cover their stamps.
std::vector<SequenceError> sequence_errors(const RadioMeasurements& radio, const Truth& truth,
                                           const std::vector<SequenceClosure>& closures);

/// Similarities of 0.1 to 0.9 for windows of 10 to 40 m. Independent of the number of threads.
std::vector<SequenceCell> measure_sequence_closures(const CarparkParams& carpark, std::uint64_t first_seed,
                                                    int seeds, const Progress& progress = {});

StudyTable sequence_table(const std::vector<SequenceCell>& cells);

}  // namespace radioslam

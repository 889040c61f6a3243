// Sequence closures against their truth: how many are found, and how good they are, over the least similarity
// of their fingerprints and the length of the windows, in simulated car parks.
// Source of the question: Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure Detection ("similarity
// threshold and window size"). A closure is right within 3 m and 20 degrees of the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/sim/carpark.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// An accepted closure and how far off it is.
struct SequenceError {
  double distance_m = 0;
  double angle_rad = 0;
  double nees = 0;  ///< squared Mahalanobis distance of the truth; 3 on average for an honest covariance

  bool right() const;
};

/// All missions at one least similarity and one length of the windows.
struct SequenceCell {
  double least_similarity = 0;
  double window_way_m = 0;
  std::size_t missions = 0;
  std::size_t candidates = 0;
  std::vector<SequenceError> accepted;
};

/// The errors of the accepted ones of these closures. The truth must know the robots' poses at their times.
std::vector<SequenceError> sequence_errors(const RadioMeasurements& radio, const Truth& truth,
                                           const std::vector<SequenceClosure>& closures);

/// Similarities of 0.1 to 0.9 for windows of 10 to 40 m. The same for any number of threads.
std::vector<SequenceCell> measure_sequence_closures(const CarparkParams& carpark, std::uint64_t first_seed,
                                                    int seeds, const Progress& progress = {});

StudyTable sequence_table(const std::vector<SequenceCell>& cells);

}  // namespace radioslam

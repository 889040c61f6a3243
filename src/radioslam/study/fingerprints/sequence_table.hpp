// Sequence closures compared with the truth in simulated car parks or recorded missions: number and accuracy,
// over the minimum similarity of their fingerprints and the length of the windows, the two parameters studied
// by Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure Detection. A closure is right within 3 m and 20
// degrees of the truth. Where the truth has positions alone (waypoints), a closure's distance is compared
// with the true one; its direction and covariance are not. Closures at times that the truth does not cover
// are left out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/study/fingerprints/study_missions.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// An accepted closure and its error.
struct SequenceError {
  double distance_m = 0;
  std::optional<double> angle_rad;
  /// Squared Mahalanobis distance of the truth; 3 on average for a consistent covariance.
  std::optional<double> nees;

  bool right() const;
};

/// All missions at one minimum similarity and one window length, with one measure.
struct SequenceCell {
  double min_similarity = 0;
  double window_path_m = 0;
  std::size_t missions = 0;
  std::size_t candidates = 0;
  std::vector<SequenceError> accepted;
  std::size_t without_truth = 0;  ///< also accepted
  std::string measure = {};       ///< empty: the default
};

/// Errors of the accepted closures whose stamps the truth covers.
std::vector<SequenceError> sequence_errors(const RadioMeasurements& radio, const Truth& truth,
                                           const std::vector<SequenceClosure>& closures);

/// Similarities of 0.1 to 0.9 for windows of 10 to 40 m, with each of the measures (an empty name: the
/// default). Independent of the number of threads.
std::vector<SequenceCell> measure_sequence_closures(const std::vector<StudyMission>& missions,
                                                    const std::vector<std::string>& measures = {""},
                                                    const Progress& progress = {});

/// `missions`: which, for the text above the table.
StudyTable sequence_table(const std::vector<SequenceCell>& cells, const std::string& missions);

}  // namespace radioslam

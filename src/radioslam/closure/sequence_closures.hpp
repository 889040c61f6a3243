// Loop closures from sequences of WiFi fingerprints: relative poses between two path segments with similar
// fingerprints, in the plane.
// Candidates are pairs (i, j) of fingerprints, of different robots or far apart along the path, that are more
// similar than any neighbouring pair along either path. Windows around both are matched (sequence_match.hpp).
// A match is accepted if its residual is small, no alternative pose fits as well, and it is precise; of
// accepted closures whose windows overlap at both ends only the most precise is kept, so that no pair of
// fingerprints counts twice. Source: Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure Detection. Cost:
// fingerprints^2 similarity look-ups and, per candidate, the square of a window's fingerprints.
#pragma once

#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_match.hpp"

namespace radioslam {

struct SequenceClosureParams {
  double min_path_m = 50;
  double min_similarity = 0.3;
  double window_path_m = 30;
  double max_sigma_m = 3;
  double max_sigma_yaw_rad = 0.35;
  SequenceMatchParams match;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        min_path_m, "m", 0, 1e6,
        "smallest path length between two fingerprints of one robot that may form a sequence closure");
    RADIOSLAM_BASIC_FIELD(min_similarity, "", 0, 1,
                          "smallest similarity of the two fingerprints of a sequence closure candidate; "
                          "lower values try more candidates");
    RADIOSLAM_FIELD(window_path_m, "m", 1, 1000,
                    "path length of the windows that are matched around both fingerprints");
    RADIOSLAM_FIELD(
        max_sigma_m, "m", 0.01, 1000,
        "largest position standard deviation of an accepted sequence closure, along its least certain axis");
    RADIOSLAM_FIELD(max_sigma_yaw_rad, "rad", 0.001, 10,
                    "largest yaw standard deviation of an accepted sequence closure");
    SequenceMatchParams::visit_fields(self.match, visit);
  }
};

/// Two fingerprints around which two windows are compared.
struct SequenceCandidate {
  std::size_t node_i = 0, node_j = 0;  ///< RadioMeasurements::nodes, node_i < node_j
  double similarity = 0;
};

/// A candidate and the result of matching its windows.
struct SequenceClosure {
  SequenceCandidate candidate;
  SequenceFit fit;
};

/// Reason for rejection; empty for an accepted closure.
std::string_view reason(SequenceStatus status);

/// Ordered by node_i, then node_j.
std::vector<SequenceCandidate> sequence_candidates(const RadioMeasurements& radio,
                                                   const SequenceClosureParams& params);

/// Candidates as they were matched when less was known, by the same model and offsets.
struct EarlierSequences {
  const RadioMeasurements& radio;
  const std::vector<SequenceClosure>& matched;
};

/// Every candidate with its match alone, in the order of candidates. Those whose windows have not changed
/// since `earlier` are not matched again. Multithreaded.
std::vector<SequenceClosure> match_sequences(const RadioMeasurements& radio,
                                             const SequenceClosureParams& params,
                                             const EarlierSequences* earlier = nullptr);

/// Every match with its status beside the others.
std::vector<SequenceClosure> choose_sequences(const RadioMeasurements& radio,
                                              std::vector<SequenceClosure> matched,
                                              const SequenceClosureParams& params);

/// Every candidate with its match and status, in the order of candidates.
std::vector<SequenceClosure> propose_sequence_closures(const RadioMeasurements& radio,
                                                       const SequenceClosureParams& params);

}  // namespace radioslam

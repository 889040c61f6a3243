// Closures between two stretches of way that sounded alike, each a relative pose.
// Candidates are pairs (i, j) of fingerprints, of different robots or a long way apart, that are more alike
// than any pair near them along either way. Around both, windows are matched (sequence_match.hpp). Accepted
// is what fits within metres, has no rival and is certain; of accepted ones whose two windows both overlap,
// the most certain one, so that no pair of fingerprints counts twice. In the plane. Source: Dammalapati and
// Hajdarpasic, WiFi Assisted Loop Closure Detection. Cost: fingerprints^2 look-ups, and per candidate the
// square of a window's fingerprints.
#pragma once

#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_match.hpp"

namespace radioslam {

struct SequenceClosureParams {
  double least_way_m = 50;              ///< between the two, within a robot
  double least_similarity = 0.3;        ///< of the two
  double window_way_m = 30;             ///< whole length of a window
  double largest_sigma_m = 3;           ///< of the position, along its loosest axis
  double largest_sigma_yaw_rad = 0.35;  ///< 20 degrees
  SequenceMatchParams match;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"least_way_m", "m", 0, 1e6, "way between two fingerprints of one robot; the seed's"},
          self.least_way_m);
    visit(Field{"least_similarity", "", 0, 1, "similarity of the two fingerprints; the seed's"},
          self.least_similarity);
    visit(Field{"window_way_m", "m", 1, 1000, "length of the ways that are matched; ours, swept"},
          self.window_way_m);
    visit(Field{"largest_sigma_m", "m", 0.01, 1000, "a closure less certain than this is none; ours"},
          self.largest_sigma_m);
    visit(Field{"largest_sigma_yaw_rad", "rad", 0.001, 10, "nor one whose yaw is; ours, 20 degrees"},
          self.largest_sigma_yaw_rad);
    SequenceMatchParams::visit_fields(self.match, visit);
  }
};

/// Two fingerprints around which two windows are compared.
struct SequenceCandidate {
  std::size_t node_i = 0, node_j = 0;  ///< RadioMeasurements::nodes, node_i < node_j
  double similarity = 0;
};

/// A candidate and what became of it.
struct SequenceClosure {
  SequenceCandidate candidate;
  SequenceFit fit;
};

/// Why a closure was not accepted; empty for an accepted one.
std::string_view reason(SequenceVerdict verdict);

/// Ordered by node_i, then node_j.
std::vector<SequenceCandidate> sequence_candidates(const RadioMeasurements& radio,
                                                   const SequenceClosureParams& params);

/// Every candidate with its verdict, in the candidates' order. Uses all threads.
std::vector<SequenceClosure> propose_sequence_closures(const RadioMeasurements& radio,
                                                       const SequenceClosureParams& params);

}  // namespace radioslam

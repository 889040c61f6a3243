// Pairs of fingerprints that say how far apart two places are.
// Source: Liu et al., algorithm 1: within a robot where the way between is longer than odometry can be
// trusted, between robots always; kept where the predicted distance is below nu.
// Where a robot's start is unknown, near pairs alone let the layout fold: there far pairs take part too, with
// the distances that laid the team out.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"

namespace radioslam {

struct FingerprintClosureParams {
  double within_distance_m = 5;   ///< nu_s
  double between_distance_m = 5;  ///< nu_p
  double nearest_factor = 1.5;    ///< nu is at least this many times the smallest distance the model predicts
  double independent_pairs = 0.5;  ///< how many of a fingerprint's pairs count as independent evidence
  int layout_pairs = 20000;        ///< far pairs at most; more are thinned and the others weigh more

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"within_distance_m", "m", 0, 1000, "largest predicted distance of a pair within a robot"},
          self.within_distance_m);
    visit(Field{"between_distance_m", "m", 0, 1000, "largest predicted distance of a pair of two robots"},
          self.between_distance_m);
    visit(Field{"nearest_factor", "", 1, 100,
                "both limits are at least this many times the smallest prediction"},
          self.nearest_factor);
    visit(Field{"independent_pairs", "", 0.01, 1e6,
                "pairs of one fingerprint share its error: together they count as this many"},
          self.independent_pairs);
    visit(Field{"layout_pairs", "", 0, 1e8, "most pairs that keep robots of unknown starts in the layout"},
          self.layout_pairs);
  }
};

/// One tie: the two fingerprints are `predicted` apart.
struct FingerprintClosure {
  std::size_t node_i = 0, node_j = 0;  ///< RadioMeasurements::nodes, node_i < node_j
  double similarity = 0;
  PredictedDistance predicted;
  double weight = 1;          ///< share of the pair that is independent evidence
  bool holds_layout = false;  ///< far apart, between robots of which one has no known start
};

/// Near pairs of fingerprints, predicted distance below nu.
std::vector<FingerprintClosure> propose_near_closures(const RadioMeasurements& radio, double trusted_way_m,
                                                      const FingerprintClosureParams& params);

/// Pairs between robots of which at least one has no known start.
std::vector<FingerprintClosure> propose_layout_closures(const Mission& mission,
                                                        const RadioMeasurements& radio,
                                                        const LayoutParams& layout,
                                                        const FingerprintClosureParams& params);

/// Both.
std::vector<FingerprintClosure> propose_fingerprint_closures(const Mission& mission,
                                                             const RadioMeasurements& radio,
                                                             double trusted_way_m, const LayoutParams& layout,
                                                             const FingerprintClosureParams& params);

}  // namespace radioslam

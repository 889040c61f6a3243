// The largest set of matches between two trajectories that are all consistent with one another: pairwise
// tests (pairwise.hpp), then the maximum clique of their graph (maximum_clique.hpp). It rejects false loop
// closures, and, with one match per path, multipath. It trusts numbers: false matches that agree with each
// other and outnumber the true ones win; `second_largest` shows how close it was.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/consistency/maximum_clique.hpp"
#include "radioslam/consistency/pairwise.hpp"

namespace radioslam {

struct ConsistentSetParams {
  PairwiseParams pairwise;
  MaximumCliqueParams clique;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    PairwiseParams::visit_fields(self.pairwise, visit);
    MaximumCliqueParams::visit_fields(self.clique, visit);
  }
};

/// Consistency of one match with the set.
struct MatchConsistency {
  bool is_in = false;
  std::size_t consistent = 0;  ///< members (itself left out) that it is consistent with
  /// Smallest statistic against a member; absent if there is no other member. To be reported for a rejected
  /// match: above the gate it is consistent with no member.
  std::optional<double> best_statistic;
};

struct ConsistentSet {
  std::vector<std::size_t> members;  ///< rising
  std::vector<MatchConsistency> matches;
  std::size_t second_largest = 0;  ///< size of the largest clique among the matches that are out
  double gate = 0;
  bool proven = true;  ///< false when the search for the largest set was cut short
};

/// Of n matches. A single match is a set of one; no matches, an empty one.
template <class Pose>
ConsistentSet largest_consistent_set(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                                     const std::vector<RelativePoseMatch<Pose>>& matches,
                                     const ConsistentSetParams& params = {});

/// The same from pairs that were tested already.
ConsistentSet largest_consistent_set(const PairwiseConsistency& pairs,
                                     const MaximumCliqueParams& params = {});

}  // namespace radioslam

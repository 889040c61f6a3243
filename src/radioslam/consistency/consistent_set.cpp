#include "radioslam/consistency/consistent_set.hpp"

namespace radioslam {
namespace {

MatchConsistency consistency_of(const PairwiseConsistency& pairs, const std::vector<std::size_t>& members,
                                std::size_t match) {
  MatchConsistency consistency;
  for (const std::size_t member : members) {
    if (member == match) {
      consistency.is_in = true;
      continue;
    }
    const double statistic = pairs.statistic(match, member);
    if (statistic <= pairs.gate) ++consistency.consistent;
    if (!consistency.best_statistic || statistic < *consistency.best_statistic)
      consistency.best_statistic = statistic;
  }
  return consistency;
}

/// What the matches that are out could agree on among themselves.
MaximumClique second_choice(const PairwiseConsistency& pairs, const ConsistentSet& set,
                            const MaximumCliqueParams& params) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < set.matches.size(); ++k)
    if (!set.matches[k].is_in) out.push_back(k);
  return maximum_clique(induced_graph(pairs.graph, out), params);
}

}  // namespace

ConsistentSet largest_consistent_set(const PairwiseConsistency& pairs, const MaximumCliqueParams& params) {
  const MaximumClique clique = maximum_clique(pairs.graph, params);
  ConsistentSet set{clique.vertices, {}, 0, pairs.gate, clique.proven};
  for (std::size_t k = 0; k < pairs.graph.size(); ++k)
    set.matches.push_back(consistency_of(pairs, set.members, k));
  set.second_largest = second_choice(pairs, set, params).vertices.size();
  return set;
}

template <class Pose>
ConsistentSet largest_consistent_set(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                                     const std::vector<RelativePoseMatch<Pose>>& matches,
                                     const ConsistentSetParams& params) {
  return largest_consistent_set(pairwise_consistency(chain_a, chain_b, matches, params.pairwise),
                                params.clique);
}

template ConsistentSet largest_consistent_set(const PoseChain<SE2>&, const PoseChain<SE2>&,
                                              const std::vector<RelativePoseMatch<SE2>>&,
                                              const ConsistentSetParams&);
template ConsistentSet largest_consistent_set(const PoseChain<SE3>&, const PoseChain<SE3>&,
                                              const std::vector<RelativePoseMatch<SE3>>&,
                                              const ConsistentSetParams&);

}  // namespace radioslam

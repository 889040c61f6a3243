// The largest set of vertices that are all neighbours of one another, exactly: NP-hard, but quick on graphs
// of consistent measurements. Branch and bound with greedy colouring as bound (Tomita & Seki 2003), on
// bitsets (San Segundo et al. 2011, BBMC), vertex by vertex in degeneracy order with the vertices of too
// small a core number left out (Rossi et al. 2014, PMC), from a greedy clique as first bound.
// The work is limited by counting, not by the clock: the same answer on every machine. Of several largest
// cliques the first one found is returned, always the same.
#pragma once

#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/consistency/undirected_graph.hpp"

namespace radioslam {

/// The order in which a graph falls apart when a vertex of the smallest remaining degree is always taken
/// away (Matula & Beck 1983). A vertex's core number is the largest such degree up to its turn; a clique of
/// k vertices is among vertices of core number k - 1 or more, and in the later neighbours of its first.
/// Cost: O(vertices^2 / 64 + edges).
struct Degeneracy {
  std::vector<std::size_t> order;  ///< vertices as they are taken; of equal degrees always in the same order
  std::vector<std::size_t> core;   ///< per vertex
};

Degeneracy degeneracy(const UndirectedGraph& graph);

// A large clique without a proof: from a start vertex, always add the common neighbour that has most
// neighbours among the common ones. Starts are the vertices in the reverse of the degeneracy order, in which
// the dense part of the graph comes first. Cost per start: at most clique size * degree * vertices / 64.

/// The largest clique found from the first `starts` vertices, in no order. Empty only for an empty graph.
std::vector<std::size_t> greedy_clique(const UndirectedGraph& graph, const Degeneracy& degeneracy,
                                       std::size_t starts);

struct MaximumCliqueParams {
  int greedy_starts = 100;
  double max_branches = 2e7;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(greedy_starts, "", 1, 1e6, "number of greedy cliques tried before the exact search");
    RADIOSLAM_FIELD(max_branches, "", 1, 1e15,
                    "largest number of branches of the exact search (about ten seconds); beyond, the best "
                    "clique found is used");
  }
};

struct MaximumClique {
  std::vector<std::size_t> vertices;  ///< rising
  bool proven = true;                 ///< false when the search gave up: a larger one may exist
  std::uint64_t branches = 0;
};

MaximumClique maximum_clique(const UndirectedGraph& graph, const MaximumCliqueParams& params = {});

}  // namespace radioslam

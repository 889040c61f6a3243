// The order in which a graph falls apart when a vertex of the smallest remaining degree is always taken
// away (Matula & Beck 1983). A vertex's core number is the largest such degree up to its turn; a clique of
// k vertices is among vertices of core number k - 1 or more, and in the later neighbours of its first.
// Cost: O(vertices^2 / 64 + edges).
#pragma once

#include <vector>

#include "radioslam/consistency/undirected_graph.hpp"

namespace radioslam {

struct Degeneracy {
  std::vector<std::size_t> order;  ///< vertices as they are taken; of equal degrees always in the same order
  std::vector<std::size_t> core;   ///< per vertex
};

Degeneracy degeneracy(const UndirectedGraph& graph);

}  // namespace radioslam

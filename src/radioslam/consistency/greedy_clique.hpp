// A large clique without a proof: from a start vertex, always add the common neighbour that has most
// neighbours among the common ones. Starts are the vertices in the reverse of the degeneracy order, in which
// the dense part of the graph comes first. Cost per start: at most clique size * degree * vertices / 64.
#pragma once

#include <vector>

#include "radioslam/consistency/degeneracy.hpp"
#include "radioslam/consistency/undirected_graph.hpp"

namespace radioslam {

/// The largest clique found from the first `starts` vertices, in no order. Empty only for an empty graph.
std::vector<std::size_t> greedy_clique(const UndirectedGraph& graph, const Degeneracy& degeneracy,
                                       std::size_t starts);

}  // namespace radioslam

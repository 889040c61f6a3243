// Random graphs for tests and benchmarks of cliques.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/consistency/undirected_graph.hpp"

namespace radioslam::test {

/// Every edge with the same probability.
inline UndirectedGraph random_graph(Rng& rng, std::size_t size, double density) {
  UndirectedGraph graph(size);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (rng.uniform() < density) graph.connect(i, j);
  return graph;
}

/// Distinct vertices, rising, all joined to one another.
inline std::vector<std::size_t> plant_clique(Rng& rng, UndirectedGraph& graph, std::size_t members) {
  std::vector<std::size_t> clique;
  while (clique.size() < members) {
    const auto v = static_cast<std::size_t>(rng.below(graph.size()));
    if (std::find(clique.begin(), clique.end(), v) == clique.end()) clique.push_back(v);
  }
  std::sort(clique.begin(), clique.end());
  for (std::size_t i = 0; i < members; ++i)
    for (std::size_t j = 0; j < i; ++j) graph.connect(clique[i], clique[j]);
  return clique;
}

}  // namespace radioslam::test

#include "radioslam/consistency/greedy_clique.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// The candidate with most neighbours among the candidates, the lowest number of equal ones.
std::size_t best_connected(const UndirectedGraph& graph, std::span<const BitWord> candidates) {
  std::size_t best = graph.size(), most = 0;
  for_each_bit(candidates, [&](std::size_t v) {
    const std::size_t common = count_common_bits(graph.neighbours(v), candidates);
    if (best == graph.size() || common > most) best = v, most = common;
  });
  return best;
}

std::vector<std::size_t> clique_from(const UndirectedGraph& graph, std::size_t start) {
  std::vector<std::size_t> clique{start};
  const auto row = graph.neighbours(start);
  std::vector<BitWord> candidates(row.begin(), row.end());
  while (true) {
    const std::size_t v = best_connected(graph, candidates);
    if (v == graph.size()) return clique;
    clique.push_back(v);
    for (std::size_t w = 0; w < candidates.size(); ++w) candidates[w] &= graph.neighbours(v)[w];
  }
}

}  // namespace

std::vector<std::size_t> greedy_clique(const UndirectedGraph& graph, const Degeneracy& degeneracy,
                                       std::size_t starts) {
  std::vector<std::size_t> best;
  const auto is_known = [&](std::size_t v) { return std::find(best.begin(), best.end(), v) != best.end(); };
  for (std::size_t k = 0; k < std::min(starts, graph.size()); ++k) {
    const std::size_t start = degeneracy.order[graph.size() - 1 - k];
    if (degeneracy.core[start] < best.size()) break;  // no later start has a larger core number
    if (is_known(start)) continue;                    // would most likely lead to the same
    auto clique = clique_from(graph, start);
    if (clique.size() > best.size()) best = std::move(clique);
  }
  return best;
}

}  // namespace radioslam

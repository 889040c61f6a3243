#include "radioslam/graph/linear/ordering.hpp"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

BlockGraph graph_of_edges(std::vector<std::uint32_t> sizes, const std::vector<Edge>& edges) {
  BlockGraph graph;
  graph.starts.assign(sizes.size() + 1, 0);
  graph.sizes = std::move(sizes);
  for (const auto& [a, b] : edges) {
    ++graph.starts[a + 1];
    ++graph.starts[b + 1];
  }
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.neighbours.resize(2 * edges.size());
  auto next = graph.starts;
  for (const auto& [a, b] : edges) {
    graph.neighbours[next[a]++] = b;
    graph.neighbours[next[b]++] = a;
  }
  for (std::size_t i = 0; i < graph.blocks(); ++i) {
    std::sort(graph.neighbours.begin() + graph.starts[i], graph.neighbours.begin() + graph.starts[i + 1]);
  }
  return graph;
}

std::vector<idx_t> metis_integers(const std::vector<std::uint32_t>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

BlockGraph block_graph(const BlockPattern& pattern) {
  std::vector<Edge> edges;
  edges.reserve(pattern.lower.size());
  for (const auto& place : pattern.lower) {
    edges.emplace_back(static_cast<std::uint32_t>(place.row), static_cast<std::uint32_t>(place.column));
  }
  return graph_of_edges({pattern.sizes.begin(), pattern.sizes.end()}, edges);
}

BlockSubgraph without_blocks(const BlockGraph& graph, const std::vector<std::uint32_t>& removed) {
  constexpr auto kRemoved = ~std::uint32_t{0};
  std::vector<std::uint32_t> name(graph.blocks(), 0);
  for (const auto block : removed) name[block] = kRemoved;
  BlockSubgraph rest;
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < graph.blocks(); ++i) {
    if (name[i] == kRemoved) continue;
    name[i] = static_cast<std::uint32_t>(rest.original.size());
    rest.original.push_back(i);
    sizes.push_back(graph.sizes[i]);
  }
  std::vector<Edge> edges;
  for (const auto i : rest.original) {
    for (auto e = graph.starts[i]; e < graph.starts[i + 1]; ++e) {
      const auto j = graph.neighbours[e];
      if (j < i && name[j] != kRemoved) edges.emplace_back(name[i], name[j]);
    }
  }
  rest.graph = graph_of_edges(std::move(sizes), edges);
  return rest;
}

EliminationOrder natural_order(const BlockGraph& graph) {
  EliminationOrder order(graph.blocks());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

EliminationOrder minimum_degree_order(const BlockGraph& graph) {
  if (graph.neighbours.empty()) return natural_order(graph);
  const std::vector<int> starts(graph.starts.begin(), graph.starts.end());
  const std::vector<int> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<int> order(graph.blocks());
  const int status = amd_order(static_cast<int>(graph.blocks()), starts.data(), neighbours.data(),
                               order.data(), nullptr, nullptr);
  RADIOSLAM_CHECK(status == AMD_OK, "AMD refused a valid graph");
  return {order.begin(), order.end()};
}

EliminationOrder nested_dissection_order(const BlockGraph& graph) {
  if (graph.neighbours.empty()) return natural_order(graph);
  auto blocks = static_cast<idx_t>(graph.blocks());
  auto starts = metis_integers(graph.starts);
  auto neighbours = metis_integers(graph.neighbours);
  auto sizes = metis_integers(graph.sizes);
  std::vector<idx_t> order(graph.blocks()), position(graph.blocks());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  static std::mutex one_at_a_time;  // METIS draws from the C library's rand(), which the whole process shares
  const std::lock_guard lock(one_at_a_time);
  const int status = METIS_NodeND(&blocks, starts.data(), neighbours.data(), sizes.data(), options,
                                  order.data(), position.data());
  RADIOSLAM_CHECK(status == METIS_OK, "METIS refused a valid graph");
  return {order.begin(), order.end()};
}

}  // namespace radioslam

// Maximum cliques planted in random graphs of density 0.3, with proof of optimality. Arguments: vertices,
// planted members (0: none). For comparison on such graphs: CLIPPER 0.3-7 ms at 500 and 30 ms at 2,000
// vertices, without proof; PMC 20 ms and 1.2-2.0 s.
#include <benchmark/benchmark.h>

#include "consistency/graphs.hpp"
#include "radioslam/consistency/maximum_clique.hpp"

namespace radioslam {
namespace {

constexpr double kDensity = 0.3;

UndirectedGraph planted_graph(const benchmark::State& state) {
  Rng rng(1);
  auto graph = test::random_graph(rng, static_cast<std::size_t>(state.range(0)), kDensity);
  test::plant_clique(rng, graph, static_cast<std::size_t>(state.range(1)));
  return graph;
}

void exact(benchmark::State& state) {
  const auto graph = planted_graph(state);
  MaximumClique found;
  for (auto _ : state) found = maximum_clique(graph);
  state.counters["members"] = static_cast<double>(found.vertices.size());
  state.counters["branches"] = static_cast<double>(found.branches);
  state.counters["proven"] = found.proven ? 1 : 0;
}

void greedy(benchmark::State& state) {
  const auto graph = planted_graph(state);
  std::vector<std::size_t> found;
  const auto starts = static_cast<std::size_t>(MaximumCliqueParams{}.greedy_starts);
  for (auto _ : state) found = greedy_clique(graph, degeneracy(graph), starts);
  state.counters["members"] = static_cast<double>(found.size());
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgsProduct({{500}, {0, 12, 20, 50}})->ArgsProduct({{2000}, {0, 20, 50, 200}});
  benchmark->Unit(benchmark::kMillisecond);
}

BENCHMARK(exact)->Apply(sizes);
BENCHMARK(greedy)->Apply(sizes);

}  // namespace
}  // namespace radioslam

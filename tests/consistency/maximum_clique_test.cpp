#include "radioslam/consistency/maximum_clique.hpp"

#include <gtest/gtest.h>

#include "consistency/graphs.hpp"

namespace radioslam {
namespace {

bool is_clique(const UndirectedGraph& graph, const std::vector<std::size_t>& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!graph.connected(vertices[i], vertices[j])) return false;
  return true;
}

/// Over all sets of vertices, up to some 18 of them.
std::size_t brute_force(const UndirectedGraph& graph) {
  std::size_t most = 0;
  for (std::size_t set = 0; set < std::size_t{1} << graph.size(); ++set) {
    const auto size = static_cast<std::size_t>(std::popcount(set));
    if (size <= most) continue;
    bool complete = true;
    for (std::size_t v = 0; v < graph.size() && complete; ++v) {
      const BitWord others = set & ~bit_of(v);
      if ((set & bit_of(v)) != 0) complete = (graph.neighbours(v)[0] & others) == others;
    }
    if (complete) most = size;
  }
  return most;
}

TEST(MaximumClique, EqualsBruteForceOnRandomGraphs) {
  Rng rng(1);
  for (int trial = 0; trial < 300; ++trial) {
    const auto size = static_cast<std::size_t>(rng.below(13));
    const auto graph = test::random_graph(rng, size, rng.uniform(0, 1));
    MaximumCliqueParams params;
    params.greedy_starts = 1;  // leave the work to the search
    const auto found = maximum_clique(graph, params);
    ASSERT_EQ(found.vertices.size(), size == 0 ? 0 : brute_force(graph)) << trial;
    EXPECT_TRUE(is_clique(graph, found.vertices));
    EXPECT_TRUE(std::is_sorted(found.vertices.begin(), found.vertices.end()));
    EXPECT_TRUE(found.proven);
  }
}

/// Complete, but for a perfect matching: 2^(n/2) largest cliques, one of each couple.
TEST(MaximumClique, TakesOneOfEachCouple) {
  UndirectedGraph graph(140);
  for (std::size_t i = 0; i < graph.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (i / 2 != j / 2) graph.connect(i, j);
  const auto found = maximum_clique(graph);
  EXPECT_EQ(found.vertices.size(), 70U);
  EXPECT_TRUE(found.proven);
  EXPECT_TRUE(is_clique(graph, found.vertices));
}

TEST(MaximumClique, FindsPlantedCliquesAmong500) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Rng rng(seed);
    auto graph = test::random_graph(rng, 500, 0.3);
    const auto planted = test::plant_clique(rng, graph, 20);
    const auto found = maximum_clique(graph);
    EXPECT_EQ(found.vertices, planted) << seed;
    EXPECT_TRUE(found.proven);
  }
}

TEST(MaximumClique, ProvesOptimaThatGreedyStartsMiss) {
  // Known clique numbers cannot be looked up for random graphs: two searches with different starts agree.
  for (std::uint64_t seed = 10; seed < 14; ++seed) {
    Rng rng(seed);
    const auto graph = test::random_graph(rng, 130, 0.6);
    MaximumCliqueParams one_start;
    one_start.greedy_starts = 1;
    const auto a = maximum_clique(graph), b = maximum_clique(graph, one_start);
    EXPECT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_TRUE(a.proven && b.proven);
    EXPECT_TRUE(is_clique(graph, a.vertices) && is_clique(graph, b.vertices));
  }
}

TEST(MaximumClique, ReportsWhenItGaveUp) {
  Rng rng(4);
  const auto graph = test::random_graph(rng, 200, 0.7);
  MaximumCliqueParams params;
  params.max_branches = 100;
  const auto found = maximum_clique(graph, params);
  EXPECT_FALSE(found.proven);
  EXPECT_EQ(found.branches, 100U);
  EXPECT_TRUE(is_clique(graph, found.vertices));
  EXPECT_GE(found.vertices.size(), 10U);
  EXPECT_EQ(found.vertices, maximum_clique(graph, params).vertices) << "the same on every run";
}

TEST(MaximumClique, WithoutEdgesIsOneVertex) {
  EXPECT_TRUE(maximum_clique(UndirectedGraph(0)).vertices.empty());
  EXPECT_EQ(maximum_clique(UndirectedGraph(100)).vertices.size(), 1U);
}

TEST(Degeneracy, OfACycleWithATail) {
  UndirectedGraph graph(7);  // a cycle 0..4, then 4-5-6
  for (std::size_t v = 0; v < 5; ++v) graph.connect(v, (v + 1) % 5);
  graph.connect(4, 5), graph.connect(5, 6);
  const auto result = degeneracy(graph);
  EXPECT_EQ(result.core, (std::vector<std::size_t>{2, 2, 2, 2, 2, 1, 1}));
  EXPECT_EQ(result.order[0], 6U);
  EXPECT_EQ(result.order[1], 5U);
}

TEST(UndirectedGraph, CountsEdgesAndCommonNeighbours) {
  UndirectedGraph graph(70);
  graph.connect(0, 69), graph.connect(1, 69), graph.connect(69, 0);
  EXPECT_EQ(graph.edges(), 2U);
  EXPECT_EQ(graph.degree(69), 2U);
  EXPECT_TRUE(graph.connected(69, 1) && graph.connected(1, 69) && !graph.connected(0, 1));
  EXPECT_EQ(count_common_bits(graph.neighbours(0), graph.neighbours(1)), 1U);
  const auto induced = induced_graph(graph, std::vector<std::size_t>{69, 1});
  EXPECT_TRUE(induced.connected(0, 1));
}

}  // namespace
}  // namespace radioslam

// Block Cholesky factorisation on the sparsity patterns of typical pose graphs. The counter `factorisations`
// is the cost of marginal covariances relative to one numeric factorisation.
#include <benchmark/benchmark.h>

#include <chrono>
#include <map>

#include "graph/linear_patterns.hpp"
#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {
namespace {

using Edges = std::set<std::pair<int, int>>;

/// A trajectory of `rings` rings of `per_ring` poses, each connected to its neighbour in the previous ring.
Edges ring_edges(int rings, int per_ring) {
  Edges edges;
  for (int i = 1; i < rings * per_ring; ++i) {
    edges.emplace(i - 1, i);
    if (i >= per_ring) edges.emplace(i - per_ring, i);
  }
  return edges;
}

BlockPattern sphere() { return test::pattern_of(std::vector<std::int32_t>(2500, 6), ring_edges(50, 50)); }

/// The last ring closes on the first, and one loop closure in ten is missing.
BlockPattern torus() {
  constexpr int kRings = 100, kPerRing = 50;
  auto edges = ring_edges(kRings, kPerRing);
  for (int i = 0; i < kPerRing; ++i) edges.emplace(i, (kRings - 1) * kPerRing + i);
  Rng rng(1);
  std::erase_if(edges, [&](const auto& edge) { return edge.second - edge.first > 1 && rng.uniform() < 0.1; });
  return test::pattern_of(std::vector<std::int32_t>(kRings * kPerRing, 6), edges);
}

/// A random walk over the crossings of a city, with a loop closure to the last visit of each crossing.
BlockPattern city() {
  constexpr int kSide = 60, kPoses = 10000;
  Rng rng(2);
  Edges edges;
  std::map<std::pair<int, int>, int> last_visit;
  int x = kSide / 2, y = kSide / 2;
  for (int i = 0; i < kPoses; ++i) {
    if (i > 0) edges.emplace(i - 1, i);
    const auto [visit, is_first] = last_visit.try_emplace({x, y}, i);
    if (!is_first && visit->second < i - 1) edges.emplace(visit->second, i);
    visit->second = i;
    auto& moved = rng.below(2) == 0 ? x : y;
    moved = std::clamp(moved + (rng.below(2) == 0 ? 1 : -1), 0, kSide - 1);
  }
  return test::pattern_of(std::vector<std::int32_t>(kPoses, 3), edges);
}

BlockPattern lattice() {
  constexpr int kSide = 12, kPoses = kSide * kSide * kSide;
  Edges edges;
  for (int i = 0; i < kPoses; ++i) {
    for (const int step : {1, kSide, kSide * kSide}) {
      if ((i / step) % kSide + 1 < kSide) edges.emplace(i, i + step);
    }
  }
  return test::pattern_of(std::vector<std::int32_t>(kPoses, 6), edges);
}

SymmetricBlockMatrix values_over(const BlockPattern& pattern) {
  Rng rng(3);
  return test::random_matrix(rng, pattern);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void analyse(benchmark::State& state, BlockPattern (*make)()) {
  const auto pattern = make();
  for (auto _ : state) benchmark::DoNotOptimize(BlockCholesky(pattern).factor_flops());
}

void factorise(benchmark::State& state, BlockPattern (*make)()) {
  const auto matrix = values_over(make());
  BlockCholesky cholesky(matrix.pattern());
  for (auto _ : state) benchmark::DoNotOptimize(cholesky.factorize(matrix));
  state.counters["flops"] =
      benchmark::Counter(cholesky.factor_flops(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["scalars"] = static_cast<double>(cholesky.factor_scalars());
}

void solve(benchmark::State& state, BlockPattern (*make)()) {
  const auto matrix = values_over(make());
  BlockCholesky cholesky(matrix.pattern());
  cholesky.factorize(matrix);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(matrix.rows()));
  for (auto _ : state) benchmark::DoNotOptimize(cholesky.solve(b));
}

double sum_of_variances(const SelectedInverse& inverse, std::size_t blocks) {
  double sum = 0;
  for (std::size_t i = 0; i < blocks; ++i) sum += inverse.diagonal(i).trace();
  return sum;
}

void all_marginals(benchmark::State& state, BlockPattern (*make)()) {
  const auto matrix = values_over(make());
  BlockCholesky cholesky(matrix.pattern());
  cholesky.factorize(matrix);
  double factorising_s = 0, inverting_s = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto start = std::chrono::steady_clock::now();
    cholesky.factorize(matrix);
    factorising_s += seconds_since(start);
    state.ResumeTiming();
    start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(sum_of_variances(cholesky.selected_inverse(), matrix.pattern().blocks()));
    inverting_s += seconds_since(start);
  }
  state.counters["factorisations"] = inverting_s / factorising_s;
}

#define RADIOSLAM_BENCH_PATTERNS(job)                                     \
  BENCHMARK_CAPTURE(job, sphere, &sphere)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(job, torus, &torus)->Unit(benchmark::kMillisecond);   \
  BENCHMARK_CAPTURE(job, city, &city)->Unit(benchmark::kMillisecond);     \
  BENCHMARK_CAPTURE(job, lattice, &lattice)->Unit(benchmark::kMillisecond)

RADIOSLAM_BENCH_PATTERNS(analyse);
RADIOSLAM_BENCH_PATTERNS(factorise);
RADIOSLAM_BENCH_PATTERNS(solve);
RADIOSLAM_BENCH_PATTERNS(all_marginals);

}  // namespace
}  // namespace radioslam

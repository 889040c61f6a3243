// Benchmark of the similarity join against comparing all pairs, on all threads.
//   join/M/s/o   100,000 fingerprints of 50 access points, from walkers on a campus of 1 km^2 with 4,000
//                access points; measure M, similarity threshold s in percent; o = 1 shuffles fingerprints
//   all_pairs/M  every pair of the first 20,000 fingerprints by similarity_table(), some rows at a time
// Counters: `pairs`, pairs found; `all_pairs_extrapolated_s`, time of similarity_table() per pair over
// kSampledRows rows spread over the recording, measured in the same run before the join, times the number of
// all pairs; `times_faster_extrapolated`, its ratio to the join's time; `missed`, sampled rows whose pairs or
// values differ from the table's, which is an error; `peak_MiB`, peak memory of the process so far,
// fingerprints included.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <utility>

#include "fingerprint_campus.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kSampledRows = 200, kRowsAtOnce = 500;

double similarity_peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

enum class Order { kWalkers, kRandom };

const std::vector<Fingerprint>& campus(Order order) {
  static const std::vector<Fingerprint> walkers = campus_fingerprints({});
  if (order == Order::kWalkers) return walkers;
  static const std::vector<Fingerprint> shuffled = [] {
    std::vector<Fingerprint> result = walkers;
    Rng rng(5);
    for (std::size_t k = result.size(); k > 1; --k) std::swap(result[k - 1], result[rng.below(k)]);
    return result;
  }();
  return shuffled;
}

/// Sampled rows of the table of all pairs, and the time per pair.
struct SampledRows {
  std::vector<std::size_t> rows;
  std::vector<std::vector<float>> table;
  double pair_s = 0;
};

SampledRows sample(const std::vector<Fingerprint>& all, SimilarityMeasure measure) {
  SampledRows sampled;
  std::vector<Fingerprint> fingerprints;
  for (std::size_t k = 0; k < kSampledRows; ++k) {
    sampled.rows.push_back(k * all.size() / kSampledRows);
    fingerprints.push_back(all[sampled.rows.back()]);
  }
  const double begin_s = seconds_now();
  sampled.table = similarity_table(fingerprints, all, measure, {});
  sampled.pair_s = (seconds_now() - begin_s) / static_cast<double>(kSampledRows * all.size());
  return sampled;
}

/// Sampled rows of an order and measure; the last result is cached.
const SampledRows& sampled_rows(Order order, SimilarityMeasure measure) {
  using Key = std::pair<Order, SimilarityMeasure>;
  static std::optional<std::pair<Key, SampledRows>> last;
  const Key key(order, measure);
  if (!last || last->first != key) {
    last.reset();
    last.emplace(key, sample(campus(order), measure));
  }
  return last->second;
}

std::size_t count_missed(const SimilarityJoin& join, const SampledRows& sampled, double minimum) {
  std::size_t missed = 0;
  for (std::size_t k = 0; k < sampled.rows.size(); ++k) {
    std::vector<SimilarPair> expected;
    const auto i = static_cast<std::uint32_t>(sampled.rows[k]);
    for (std::uint32_t j = i + 1; j < sampled.table[k].size(); ++j)
      if (static_cast<double>(sampled.table[k][j]) >= minimum)
        expected.push_back({i, j, sampled.table[k][j]});
    if (join.pairs_of(i, i + 1) != expected) ++missed;
  }
  return missed;
}

/// Counts the pairs, some rows at a time, as a program would write them to a file.
std::size_t count_pairs(const SimilarityJoin& join) {
  std::vector<std::size_t> counts((join.rows() + SimilarityJoin::kRowsTogether - 1) /
                                  SimilarityJoin::kRowsTogether);
  parallel_for(counts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const std::size_t row = g * SimilarityJoin::kRowsTogether;
      counts[g] = join.pairs_of(row, std::min(join.rows(), row + SimilarityJoin::kRowsTogether)).size();
    }
  });
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

void join(benchmark::State& state, SimilarityMeasure measure) {
  const double minimum = static_cast<double>(state.range(0)) / 100;
  const Order order = state.range(1) == 0 ? Order::kWalkers : Order::kRandom;
  const auto& all = campus(order);
  const SampledRows& sampled = sampled_rows(order, measure);
  double took_s = 0;
  for (auto _ : state) {
    const double begin_s = seconds_now();
    const auto joined = SimilarityJoin::within(all, {measure, {}, minimum});
    state.counters["pairs"] = static_cast<double>(count_pairs(joined));
    took_s = seconds_now() - begin_s;
    state.SetIterationTime(took_s);
    const std::size_t missed = count_missed(joined, sampled, minimum);
    state.counters["missed"] = static_cast<double>(missed);
    if (missed > 0) {
      state.SkipWithError("the join's pairs differ from those of the table");
      return;
    }
  }
  const double n = static_cast<double>(all.size());
  state.counters["all_pairs_extrapolated_s"] = sampled.pair_s * n * (n - 1) / 2;
  state.counters["times_faster_extrapolated"] = sampled.pair_s * n * (n - 1) / 2 / took_s;
  state.counters["peak_MiB"] = similarity_peak_mib();
}

void all_pairs(benchmark::State& state, SimilarityMeasure measure) {
  const auto& campus_all = campus(Order::kWalkers);
  const std::vector<Fingerprint> all(campus_all.begin(), campus_all.begin() + 20000);
  for (auto _ : state) {
    for (std::size_t i = 0; i < all.size(); i += kRowsAtOnce) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(i);
      // One recording with itself: only columns from the row's own on.
      const std::vector<Fingerprint> rows(first, first + kRowsAtOnce), columns(first, all.end());
      benchmark::DoNotOptimize(similarity_table(rows, columns, measure, {}));
    }
  }
}

void configure(benchmark::internal::Benchmark* bench) {
  for (const int order : {0, 1})
    for (const int percent : {30, 50, 80}) bench->Args({percent, order});
  bench->Iterations(1)->UseManualTime()->Unit(benchmark::kSecond);
}

BENCHMARK_CAPTURE(all_pairs, gaussian, SimilarityMeasure::kGaussian)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(join, cosine, SimilarityMeasure::kCosine)->Apply(configure);
BENCHMARK_CAPTURE(join, gaussian, SimilarityMeasure::kGaussian)->Apply(configure);
BENCHMARK_CAPTURE(join, detection, SimilarityMeasure::kDetection)->Apply(configure);
BENCHMARK_CAPTURE(join, slide, SimilarityMeasure::kProduct)->Apply(configure);
BENCHMARK_CAPTURE(join, mended, SimilarityMeasure::kGeometricMean)->Apply(configure);
BENCHMARK_CAPTURE(join, sorensen, SimilarityMeasure::kSorensen)->Apply(configure);

}  // namespace
}  // namespace radioslam

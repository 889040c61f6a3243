// Scan Context in a simulated town: comparing two scans, and searching the best of 10,000, on one core.
//   compare/rings          two random places; `times_faster` than shift by shift as in the paper
//   search/rings/scanners  places up to 3 m from a scanned one, with any heading; scanners: 0 the same,
//                          1 another with other beams at another height
//   ring_search            the same with the paper's ring key and 50 nearest keys, as in DiSCo-SLAM
// Counters of searches: `recall`, ratio of searches that find the best of all; `exhaustive_ms`, time to
// compare all; `right`, ratio of searches whose result is within 5 m, and `exhaustive_right`, the same of the
// best of all.
#include <benchmark/benchmark.h>

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "places/compare_by_shifts.hpp"
#include "places/scanned_town.hpp"
#include "radioslam/places/scan_context_index.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPlaces = 10000, kQueries = 300;
constexpr double kRight_m = 5;

enum class Scanners { kSame, kOther };

struct PlaceRecording {
  std::vector<test::TownPose> places, queries;
  std::vector<ScanContext> contexts, query_contexts;
  std::vector<Neighbour> best;  ///< of all, per query
  double exhaustive_ms = 0;
};

double milliseconds_now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(since).count();
}

PlaceRecording record_places(int rings, Scanners scanners) {
  using namespace test;
  Rng rng(1);
  const Town town = random_town(20, rng);
  const TownScanner scanner;
  TownScanner other = scanner;
  if (scanners == Scanners::kOther) {
    other.height_m = 0.8;
    other.beams = 18;
    other.dropout_ratio = 0.2;
  }
  ScanContextParams params;
  params.rings = rings;
  const auto context_at = [&](const TownPose& pose, const TownScanner& with) {
    return make_scan_context(scan_town(town, pose, with, rng), with.max_range_m, ScanContextKind::kHeight,
                             params);
  };
  PlaceRecording made;
  made.places = drive(town, kPlaces, 1, rng);
  for (const TownPose& pose : made.places) made.contexts.push_back(context_at(pose, scanner));
  for (std::size_t k = 0; k < kQueries; ++k) {
    made.queries.push_back(revisited(made.places[rng.below(kPlaces)], 3, rng));
    made.query_contexts.push_back(context_at(made.queries.back(), other));
  }
  return made;
}

double right_ratio(const PlaceRecording& recording, const std::vector<Neighbour>& found) {
  double right = 0;
  for (std::size_t k = 0; k < kQueries; ++k) {
    const Eigen::Vector2d offset = recording.places[found[k].index].position - recording.queries[k].position;
    if (offset.norm() < kRight_m) right += 1.0 / kQueries;
  }
  return right;
}

ScanContextIndex index_of(const PlaceRecording& recording, const ScanContextIndexParams& params) {
  ScanContextIndex index(params);
  for (const ScanContext& context : recording.contexts) index.add(context);
  return index;
}

/// With the best of all per query; the last recording is cached.
const PlaceRecording& place_recording(int rings, Scanners scanners) {
  using Key = std::pair<int, Scanners>;
  static std::optional<std::pair<Key, PlaceRecording>> last;
  const Key key(rings, scanners);
  if (last && last->first == key) return last->second;
  last.reset();
  last.emplace(key, record_places(rings, scanners));
  PlaceRecording& made = last->second;
  const ScanContextIndex index = index_of(made, {});
  const double begin_ms = milliseconds_now();
  for (const ScanContext& query : made.query_contexts)
    made.best.push_back(index.nearest_exhaustively(query, 1).front());
  made.exhaustive_ms = (milliseconds_now() - begin_ms) / kQueries;
  return made;
}

void search_places(benchmark::State& state, const ScanContextIndexParams& params) {
  const Scanners scanners = state.range(1) == 0 ? Scanners::kSame : Scanners::kOther;
  const PlaceRecording& recording = place_recording(static_cast<int>(state.range(0)), scanners);
  const ScanContextIndex index = index_of(recording, params);
  std::size_t next = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(index.nearest(recording.query_contexts[next++ % kQueries], 1));
  std::vector<Neighbour> found;
  double hits = 0;
  for (std::size_t k = 0; k < kQueries; ++k) {
    found.push_back(index.nearest(recording.query_contexts[k], 1).front());
    if (found[k].match.distance - recording.best[k].match.distance < 1e-9) hits += 1.0 / kQueries;
  }
  state.counters["recall"] = hits;
  state.counters["exhaustive_ms"] = recording.exhaustive_ms;
  state.counters["right"] = right_ratio(recording, found);
  state.counters["exhaustive_right"] = right_ratio(recording, recording.best);
}

void compare_places(benchmark::State& state) {
  constexpr std::size_t kPairs = 500, kStride = 19;
  const PlaceRecording& recording = place_recording(static_cast<int>(state.range(0)), Scanners::kSame);
  const auto& contexts = recording.contexts;
  const double begin_ms = milliseconds_now();
  for (std::size_t k = 0; k < kPairs; ++k)
    benchmark::DoNotOptimize(test::distance_by_shifts(contexts[k], contexts[kStride * k]));
  const double by_shifts_ms = (milliseconds_now() - begin_ms) / kPairs;
  double compared = 0;
  const double first_ms = milliseconds_now();
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPairs; ++k)
      benchmark::DoNotOptimize(compare(contexts[k], contexts[kStride * k]));
    compared += kPairs;
  }
  const double each_ms = (milliseconds_now() - first_ms) / compared;
  state.counters["each_us"] = 1e3 * each_ms;
  state.counters["by_shifts_us"] = 1e3 * by_shifts_ms;
  state.counters["times_faster"] = by_shifts_ms / each_ms;
}

void search(benchmark::State& state) { search_places(state, {}); }
void ring_search(benchmark::State& state) { search_places(state, {"ring", 50, 50}); }

void rings_and_scanners(benchmark::internal::Benchmark* bench) {
  for (const int rings : {20, 64})
    for (const int scanners : {0, 1}) bench->Args({rings, scanners});
  bench->Unit(benchmark::kMillisecond);
}

BENCHMARK(compare_places)->Name("compare")->Arg(20)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(search)->Apply(rings_and_scanners);
BENCHMARK(ring_search)->Apply(rings_and_scanners);

}  // namespace
}  // namespace radioslam

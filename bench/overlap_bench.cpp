// Overlap search for two robots that drive the streets of a town, in both modes, on one core.
//   town/...      1.1 M pairs, the size of KITTI 08 split in two
//   country/n     n poses per robot in an area that grows with n, so that the pairs kept grow linearly
// Counters: pairs; kept; `evaluated`: distances evaluated relative to the allowance of three per pair kept
// and one per pose; `items_per_s`: poses and pairs kept; `prepare`: time for the covariances before the
// search.
#include <benchmark/benchmark.h>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/overlap_growth/overlap_growth.hpp"

namespace radioslam {
namespace {

void count(benchmark::State& state, const OverlapCandidates& found, std::size_t poses) {
  const auto kept = static_cast<double>(found.counts.kept), n = 2 * static_cast<double>(poses);
  state.counters["pairs"] = static_cast<double>(found.counts.pairs);
  state.counters["kept"] = kept;
  state.counters["boxes"] = static_cast<double>(found.counts.boxes_visited);
  state.counters["evaluated"] = static_cast<double>(found.counts.distances_evaluated) / (3 * kept + n);
  state.counters["items_per_s"] = benchmark::Counter(kept + n, benchmark::Counter::kIsIterationInvariantRate);
}

enum class How { kBoxes, kAllPairs };

template <class Source>
void search(benchmark::State& state, const Source& source, const OverlapTeam& team, How how) {
  set_thread_count(1);
  OverlapCandidates found;
  for (auto _ : state)
    found = how == How::kBoxes ? search_overlaps(source, team.sensors, {})
                               : search_overlaps_exhaustively(source, team.sensors, {});
  count(state, found, team.chains[0].poses.size());
}

void joint(benchmark::State& state, const OverlapTown& town, How how) {
  const OverlapTeam team = draw_team(town);
  const OverlapTeamGraph g = graph_of(team);
  const auto source = JointCovariance<SE2>::compute(g.graph, g.robots);
  search(state, *source, team, how);
}

void link(benchmark::State& state, const OverlapTown& town, How how) {
  const OverlapTeam team = draw_team(town);
  search(state, LinkCovariance<SE2>(team.chains, team.links), team, how);
}

void prepare_joint(benchmark::State& state, const OverlapTown& town) {
  const OverlapTeamGraph g = graph_of(draw_team(town));
  for (auto _ : state) benchmark::DoNotOptimize(JointCovariance<SE2>::compute(g.graph, g.robots));
}

void prepare_link(benchmark::State& state, const OverlapTown& town) {
  const OverlapTeam team = draw_team(town);
  for (auto _ : state) benchmark::DoNotOptimize(LinkCovariance<SE2>(team.chains, team.links));
}

void joint_town(benchmark::State& s) { joint(s, {}, How::kBoxes); }
void joint_town_all_pairs(benchmark::State& s) { joint(s, {}, How::kAllPairs); }
void joint_town_prepare(benchmark::State& s) { prepare_joint(s, {}); }
void link_town(benchmark::State& s) { link(s, {}, How::kBoxes); }
void link_town_all_pairs(benchmark::State& s) { link(s, {}, How::kAllPairs); }
void link_town_prepare(benchmark::State& s) { prepare_link(s, {}); }
void joint_country(benchmark::State& s) {
  joint(s, growing_town(static_cast<std::size_t>(s.range())), How::kBoxes);
}
void joint_country_prepare(benchmark::State& s) {
  prepare_joint(s, growing_town(static_cast<std::size_t>(s.range())));
}
void link_country(benchmark::State& s) {
  link(s, growing_town(static_cast<std::size_t>(s.range())), How::kBoxes);
}

BENCHMARK(joint_town)->Unit(benchmark::kMillisecond);
BENCHMARK(joint_town_all_pairs)->Unit(benchmark::kMillisecond);
BENCHMARK(joint_town_prepare)->Unit(benchmark::kMillisecond);
BENCHMARK(link_town)->Unit(benchmark::kMillisecond);
BENCHMARK(link_town_all_pairs)->Unit(benchmark::kMillisecond);
BENCHMARK(link_town_prepare)->Unit(benchmark::kMillisecond);
BENCHMARK(joint_country)->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(joint_country_prepare)->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(link_country)->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace radioslam

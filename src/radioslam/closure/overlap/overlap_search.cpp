#include "radioslam/closure/overlap/overlap_search.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/overlap/overlap_box_search.hpp"

namespace radioslam {
namespace {

/// Poses of the first robot per task of the exhaustive search.
constexpr std::size_t kRowsPerTask = 64;

/// Compares all pairs of poses of two intervals.
template <OverlapSource Source>
OverlapCandidates compare_intervals(const OverlapPair<Source>& pair, const PoseInterval& p,
                                    const PoseInterval& q, OverlapCandidates found) {
  const auto ties = pair.all_ties();
  const std::size_t tasks = (p.size() + kRowsPerTask - 1) / kRowsPerTask;
  return gather_overlaps(tasks, std::move(found), [&](std::size_t t, OverlapCandidates& out) {
    const std::size_t begin = p.begin + t * kRowsPerTask;
    for (std::size_t k = begin; k < std::min(p.end, begin + kRowsPerTask); ++k)
      for (std::size_t l = q.begin; l < q.end; ++l)
        pair.compare(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(l), ties, out);
  });
}

/// Compares all pairs of poses of a run of one robot and another robot.
template <OverlapSource Source>
OverlapCandidates compare_all_pairs(const OverlapPair<Source>& pair, const Source& source,
                                    const PoseInterval& run) {
  OverlapCandidates found;
  if (pair.view().ties() == 0) return found;
  const auto &pieces_a = source.pieces(pair.a()), &pieces_b = source.pieces(pair.b());
  for (std::size_t p = 0; p < pieces_a.size(); ++p)
    for (std::size_t q = 0; q < pieces_b.size(); ++q)
      if (source.joined(pair.a(), p, pair.b(), q))
        found = compare_intervals(pair, common(pieces_a[p], run), pieces_b[q], std::move(found));
  return found;
}

/// The whole team's candidates in one list.
template <OverlapSource Source>
OverlapCandidates collected(const TeamOverlapSearch<Source>& search, std::size_t robots) {
  OverlapCandidates all;
  for (std::uint32_t a = 0; a < robots; ++a)
    all.counts += search.search(a, [&](std::vector<OverlapCandidate> found) {
      all.candidates.insert(all.candidates.end(), found.begin(), found.end());
    });
  return all;
}

}  // namespace

template <OverlapSource Source>
TeamOverlapSearch<Source>::TeamOverlapSearch(const Source& source, std::vector<OverlapSensor> sensors,
                                             const OverlapParams& params, SearchMethod method)
    : source_(source), sensors_(std::move(sensors)), params_(params), method_(method) {
  RADIOSLAM_CHECK(sensors_.size() == source.robots(), "every robot has a sensor");
  if (method == SearchMethod::kExhaustive) return;
  trees_.resize(source.robots());
  parallel_for(trees_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = std::max<std::size_t>(begin, 1); r < end; ++r)
      trees_[r] = OverlapTreeBuilder<Source>(source, r).build();
  });
}

template <OverlapSource Source>
OverlapCounts TeamOverlapSearch<Source>::search(std::uint32_t a, const TakeOverlaps& take) const {
  const auto robots = static_cast<std::uint32_t>(source_.robots());
  std::vector<OverlapCandidates> found(robots);
  if (a + 1 == robots) return {};
  for (const PoseInterval& run : source_.runs(a)) {
    const auto columns = source_.columns(a, run);
    const bool by_tree = method_ == SearchMethod::kTree;
    const Tree tree = by_tree ? OverlapTreeBuilder<Source>(source_, a).build(run) : Tree();
    parallel_for(robots - a - 1, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = a + 1 + begin; b < a + 1 + end; ++b) {
        const OverlapRule rule = overlap_rule(params_, sensors_[a], sensors_[b]);
        const auto other = static_cast<std::uint32_t>(b);
        const OverlapPair<Source> pair(source_, a, other, source_.view(a, b, columns), rule);
        append(found[b], by_tree ? OverlapBoxSearch<Source>(pair, tree, trees_[b]).run(source_)
                                 : compare_all_pairs(pair, source_, run));
      }
    });
  }
  parallel_for(robots, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      std::sort(found[b].candidates.begin(), found[b].candidates.end(), [](const auto& x, const auto& y) {
        return std::pair(x.pose_a, x.pose_b) < std::pair(y.pose_a, y.pose_b);
      });
  });
  OverlapCounts counts;
  for (std::uint32_t b = a + 1; b < robots; ++b) {
    found[b].counts.pairs = std::uint64_t{source_.records(a).size()} * source_.records(b).size();
    counts += found[b].counts;
    take(std::move(found[b].candidates));
  }
  return counts;
}

template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params) {
  return collected(TeamOverlapSearch<Source>(source, sensors, params, SearchMethod::kTree), source.robots());
}

template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params) {
  return collected(TeamOverlapSearch<Source>(source, sensors, params, SearchMethod::kExhaustive),
                   source.robots());
}

#define RADIOSLAM_OVERLAP_SEARCH(Source)                                                                    \
  template class TeamOverlapSearch<Source>;                                                                 \
  template OverlapCandidates search_overlaps(const Source&, const std::vector<OverlapSensor>&,              \
                                             const OverlapParams&);                                         \
  template OverlapCandidates search_overlaps_exhaustively(const Source&, const std::vector<OverlapSensor>&, \
                                                          const OverlapParams&)
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE3>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE3>);

}  // namespace radioslam

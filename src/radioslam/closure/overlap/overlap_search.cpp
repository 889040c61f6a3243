#include "radioslam/closure/overlap/overlap_search.hpp"

#include <algorithm>

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

/// For every run of a robot's poses calls search_run(robot, run), and what that returns with the OverlapPair
/// of every later robot. Hands over the sorted results.
template <OverlapSource Source, class SearchRun>
OverlapCounts over_team(const Source& source, const std::vector<OverlapSensor>& sensors,
                        const OverlapParams& params, const TakeOverlaps& take, SearchRun&& search_run) {
  RADIOSLAM_CHECK(sensors.size() == source.robots(), "every robot has a sensor");
  const auto robots = static_cast<std::uint32_t>(source.robots());
  OverlapCounts counts;
  for (std::uint32_t a = 0; a + 1 < robots; ++a) {
    std::vector<OverlapCandidates> found(robots);
    for (const PoseInterval& run : source.runs(a)) {
      const auto columns = source.columns(a, run);
      const auto search = search_run(a, run);
      for (std::uint32_t b = a + 1; b < robots; ++b) {
        const OverlapRule rule{params.max_mahalanobis, overlap_distance(params), sensors[a], sensors[b]};
        const OverlapPair<Source> pair(source, a, b, source.view(a, b, columns), rule);
        append(found[b], search(pair));
      }
    }
    for (std::uint32_t b = a + 1; b < robots; ++b) {
      found[b].counts.pairs = std::uint64_t{source.records(a).size()} * source.records(b).size();
      std::sort(found[b].candidates.begin(), found[b].candidates.end(), [](const auto& x, const auto& y) {
        return std::pair(x.pose_a, x.pose_b) < std::pair(y.pose_a, y.pose_b);
      });
      counts += found[b].counts;
      take(std::move(found[b].candidates));
    }
  }
  return counts;
}

/// The results of a search in one list.
template <class Search>
OverlapCandidates collected(Search&& search) {
  OverlapCandidates all;
  all.counts = search([&](std::vector<OverlapCandidate> found) {
    all.candidates.insert(all.candidates.end(), found.begin(), found.end());
  });
  return all;
}

}  // namespace

template <OverlapSource Source>
OverlapCounts search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                              const OverlapParams& params, const TakeOverlaps& take) {
  using Pose = typename Source::View::Pose;
  std::vector<OverlapTree<Pose>> trees(source.robots());
  parallel_for(trees.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = std::max<std::size_t>(begin, 1); r < end; ++r)
      trees[r] = OverlapTreeBuilder<Source>(source, r).build();
  });
  return over_team(source, sensors, params, take, [&](std::uint32_t a, const PoseInterval& run) {
    return [&, tree = OverlapTreeBuilder<Source>(source, a).build(run)](const OverlapPair<Source>& pair) {
      return OverlapBoxSearch<Source>(pair, tree, trees[pair.b()]).run(source);
    };
  });
}

template <OverlapSource Source>
OverlapCounts search_overlaps_exhaustively(const Source& source, const std::vector<OverlapSensor>& sensors,
                                           const OverlapParams& params, const TakeOverlaps& take) {
  return over_team(source, sensors, params, take, [&](std::uint32_t, const PoseInterval& run) {
    return [&](const OverlapPair<Source>& pair) { return compare_all_pairs(pair, source, run); };
  });
}

template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params) {
  return collected([&](const TakeOverlaps& take) { return search_overlaps(source, sensors, params, take); });
}

template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params) {
  return collected(
      [&](const TakeOverlaps& take) { return search_overlaps_exhaustively(source, sensors, params, take); });
}

#define RADIOSLAM_OVERLAP_SEARCH(Source)                                                                    \
  template OverlapCounts search_overlaps(const Source&, const std::vector<OverlapSensor>&,                  \
                                         const OverlapParams&, const TakeOverlaps&);                        \
  template OverlapCounts search_overlaps_exhaustively(const Source&, const std::vector<OverlapSensor>&,     \
                                                      const OverlapParams&, const TakeOverlaps&);           \
  template OverlapCandidates search_overlaps(const Source&, const std::vector<OverlapSensor>&,              \
                                             const OverlapParams&);                                         \
  template OverlapCandidates search_overlaps_exhaustively(const Source&, const std::vector<OverlapSensor>&, \
                                                          const OverlapParams&)
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE3>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE3>);

}  // namespace radioslam

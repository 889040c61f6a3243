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

/// Compares all pairs of poses of two robots.
template <OverlapSource Source>
OverlapCandidates compare_all_pairs(const OverlapPair<Source>& pair, const Source& source) {
  OverlapCandidates found;
  if (pair.view().ties() == 0) return found;
  for (std::size_t p = 0; p < source.pieces(pair.a()).size(); ++p)
    for (std::size_t q = 0; q < source.pieces(pair.b()).size(); ++q)
      if (source.joined(pair.a(), p, pair.b(), q))
        found =
            compare_intervals(pair, source.pieces(pair.a())[p], source.pieces(pair.b())[q], std::move(found));
  return found;
}

/// Calls search(OverlapPair) for every two robots and concatenates the sorted results.
template <OverlapSource Source, class Search>
OverlapCandidates over_team(const Source& source, const std::vector<OverlapSensor>& sensors,
                            const OverlapParams& params, Search&& search) {
  RADIOSLAM_CHECK(sensors.size() == source.robots(), "every robot has a sensor");
  OverlapCandidates all;
  for (std::uint32_t a = 0; a < source.robots(); ++a)
    for (std::uint32_t b = a + 1; b < source.robots(); ++b) {
      const OverlapRule rule{params.max_mahalanobis, overlap_distance(params), sensors[a], sensors[b]};
      const OverlapPair<Source> pair(source, a, b, rule);
      OverlapCandidates found = search(pair);
      found.counts.pairs = std::uint64_t{source.records(a).size()} * source.records(b).size();
      std::sort(found.candidates.begin(), found.candidates.end(), [](const auto& x, const auto& y) {
        return std::pair(x.pose_a, x.pose_b) < std::pair(y.pose_a, y.pose_b);
      });
      all.candidates.insert(all.candidates.end(), found.candidates.begin(), found.candidates.end());
      all.counts += found.counts;
    }
  return all;
}

}  // namespace

template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params) {
  using Pose = typename Source::View::Pose;
  std::vector<OverlapTree<Pose>> trees(source.robots());
  parallel_for(trees.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) trees[r] = OverlapTreeBuilder<Source>(source, r).build();
  });
  return over_team(source, sensors, params, [&](const auto& pair) {
    return OverlapBoxSearch<Source>(pair, trees[pair.a()], trees[pair.b()]).run(source);
  });
}

template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params) {
  return over_team(source, sensors, params,
                   [&](const auto& pair) { return compare_all_pairs(pair, source); });
}

#define RADIOSLAM_OVERLAP_SEARCH(Source)                                                                    \
  template OverlapCandidates search_overlaps(const Source&, const std::vector<OverlapSensor>&,              \
                                             const OverlapParams&);                                         \
  template OverlapCandidates search_overlaps_exhaustively(const Source&, const std::vector<OverlapSensor>&, \
                                                          const OverlapParams&)
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(LinkCovariance<SE3>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE2>);
RADIOSLAM_OVERLAP_SEARCH(JointCovariance<SE3>);

}  // namespace radioslam

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

/// Compares all pairs of poses of a run of one robot and another robot.
template <OverlapPoses Poses>
OverlapCandidates compare_all_pairs(const OverlapTest<typename Poses::View>& test, RobotPair robots,
                                    const Poses& a, const PoseInterval& run, const Poses& b) {
  const auto ties = all_ties(test.view());
  OverlapCandidates found;
  if (ties.empty()) return found;
  for (std::size_t p = 0; p < a.pieces().size(); ++p)
    for (std::size_t q = 0; q < b.pieces().size(); ++q) {
      if (a.component(p) != b.component(q)) continue;
      const PoseInterval rows = common(a.pieces()[p], run), columns = b.pieces()[q];
      const std::size_t tasks = (rows.size() + kRowsPerTask - 1) / kRowsPerTask;
      found = gather_overlaps(tasks, std::move(found), [&](std::size_t t, OverlapCandidates& out) {
        const std::size_t begin = rows.begin + t * kRowsPerTask;
        for (std::size_t k = begin; k < std::min(rows.end, begin + kRowsPerTask); ++k)
          for (std::size_t l = columns.begin; l < columns.end; ++l)
            test.compare({robots.a, robots.b, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(l)},
                         a.records()[k], b.records()[l], ties, out);
      });
    }
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

void sort_by_poses(std::vector<OverlapCandidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const auto& x, const auto& y) {
    return std::pair(x.pose_a, x.pose_b) < std::pair(y.pose_a, y.pose_b);
  });
}

template <OverlapSource Source>
TeamOverlapSearch<Source>::TeamOverlapSearch(const Source& source, std::vector<OverlapSensor> sensors,
                                             const OverlapParams& params, SearchMethod method)
    : source_(source), sensors_(std::move(sensors)), params_(params), method_(method) {
  RADIOSLAM_CHECK(sensors_.size() == source.robots(), "every robot has a sensor");
  if (method == SearchMethod::kExhaustive) return;
  trees_.resize(source.robots());
  parallel_for(trees_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = std::max<std::size_t>(begin, 1); r < end; ++r)
      trees_[r] = OverlapTreeBuilder<Poses>(source.poses(r)).build();
  });
}

template <OverlapSource Source>
OverlapCounts TeamOverlapSearch<Source>::search(std::uint32_t a, const TakeOverlaps& take) const {
  const auto robots = static_cast<std::uint32_t>(source_.robots());
  std::vector<OverlapCandidates> found(robots);
  if (a + 1 == robots) return {};
  const Poses& poses = source_.poses(a);
  for (const PoseInterval& run : source_.team().runs(a, poses)) {
    const auto columns = source_.team().columns(a, poses, run);
    const bool by_tree = method_ == SearchMethod::kTree;
    const Tree tree = by_tree ? OverlapTreeBuilder<Poses>(poses).build(run) : Tree();
    parallel_for(robots - a - 1, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = a + 1 + begin; b < a + 1 + end; ++b) {
        const OverlapRule rule = overlap_rule(params_, sensors_[a], sensors_[b]);
        const RobotPair pair{a, static_cast<std::uint32_t>(b)};
        const View view = source_.team().view(a, b, columns);
        const Poses& other = source_.poses(b);
        if (!by_tree) {
          append(found[b], compare_all_pairs({view, rule}, pair, poses, run, other));
          continue;
        }
        const KnownBoxes<View> boxes(trees_[b], other.records());
        append(found[b], OverlapBoxSearch(view, rule, pair, tree, poses.records(), boxes).run());
      }
    });
  }
  parallel_for(robots, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) sort_by_poses(found[b].candidates);
  });
  OverlapCounts counts;
  for (std::uint32_t b = a + 1; b < robots; ++b) {
    found[b].counts.pairs = std::uint64_t{poses.records().size()} * source_.poses(b).records().size();
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

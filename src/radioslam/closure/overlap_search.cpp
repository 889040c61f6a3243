#include "radioslam/closure/overlap_search.hpp"

#include <algorithm>
#include <deque>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/overlap_judge.hpp"

namespace radioslam {
namespace {

/// Boxes that are opened before threads share the work: enough to keep many busy, few enough to cost nothing.
constexpr std::size_t kTasks = 512;
/// Boxes above one another: two trees of 32-bit pose indices, halved.
constexpr std::size_t kDeepest = 2 * 32 + 2;
/// Poses of the first robot per task of the exhaustive search.
constexpr std::size_t kRowsPerTask = 64;

/// The search between two robots.
template <OverlapSource Source>
class PairSearch {
 public:
  using View = typename Source::View;
  using Pose = typename View::Pose;
  using Judge = OverlapJudge<View>;
  using Bound = TieBound<Pose>;
  using Node = OverlapNode<Pose>;

  struct Task {
    std::uint32_t node_a, node_b;
    std::vector<Bound> ties;
  };

  PairSearch(const Source& source, std::uint32_t a, std::uint32_t b, const OverlapRule& rule)
      : a_(a),
        b_(b),
        records_a_(source.records(a)),
        records_b_(source.records(b)),
        view_(source.view(a, b)),
        judge_(view_, rule) {}

  OverlapCandidates in_boxes(const Source& source, const OverlapTree<Pose>& A, const OverlapTree<Pose>& B) {
    tree_a_ = &A;
    tree_b_ = &B;
    OverlapCandidates found;
    const std::vector<Task> tasks = open(first_tasks(source), found);
    return gather(tasks.size(), std::move(found), [&](std::size_t t, OverlapCandidates& out) {
      std::vector<std::vector<Bound>> levels(kDeepest);
      walk(tasks[t].node_a, tasks[t].node_b, tasks[t].ties, 0, levels, out);
    });
  }

  OverlapCandidates over_all(const Source& source) {
    OverlapCandidates found;
    const std::vector<Bound> ties = all_ties();
    for (std::size_t p = 0; p < source.pieces(a_).size(); ++p)
      for (std::size_t q = 0; q < source.pieces(b_).size(); ++q)
        if (!ties.empty() && source.joined(a_, p, b_, q))
          found = compare_pieces(source.pieces(a_)[p], source.pieces(b_)[q], ties, std::move(found));
    return found;
  }

 private:
  const Node& node_a(std::uint32_t i) const { return tree_a_->nodes[i]; }
  const Node& node_b(std::uint32_t j) const { return tree_b_->nodes[j]; }

  /// Calls work(task, its own result) for every task and appends the results in order.
  template <class Work>
  static OverlapCandidates gather(std::size_t tasks, OverlapCandidates found, Work&& work) {
    std::vector<OverlapCandidates> parts(tasks);
    parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) work(t, parts[t]);
    });
    for (const auto& part : parts) {
      found.candidates.insert(found.candidates.end(), part.candidates.begin(), part.candidates.end());
      found.counts += part.counts;
    }
    return found;
  }

  std::vector<Bound> all_ties() const {
    std::vector<Bound> ties(view_.ties());
    for (std::size_t t = 0; t < ties.size(); ++t) ties[t].tie = static_cast<std::uint32_t>(t);
    return ties;
  }

  std::deque<Task> first_tasks(const Source& source) const {
    std::deque<Task> tasks;
    if (view_.ties() == 0) return tasks;
    for (std::size_t p = 0; p < tree_a_->roots.size(); ++p)
      for (std::size_t q = 0; q < tree_b_->roots.size(); ++q)
        if (source.joined(a_, p, b_, q)) tasks.push_back({tree_a_->roots[p], tree_b_->roots[q], all_ties()});
    return tasks;
  }

  void compare(std::uint32_t k, std::uint32_t l, std::span<const Bound> ties, OverlapCandidates& out) const {
    judge_.compare({a_, b_, k, l}, records_a_[k], records_b_[l], ties, out);
  }

  OverlapCandidates compare_pieces(const PoseInterval& p, const PoseInterval& q,
                                   const std::vector<Bound>& ties, OverlapCandidates found) const {
    const std::size_t tasks = (p.size() + kRowsPerTask - 1) / kRowsPerTask;
    return gather(tasks, std::move(found), [&](std::size_t t, OverlapCandidates& out) {
      const std::size_t begin = p.begin + t * kRowsPerTask;
      for (std::size_t k = begin; k < std::min(p.end, begin + kRowsPerTask); ++k)
        for (std::size_t l = q.begin; l < q.end; ++l)
          compare(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(l), ties, out);
    });
  }

  BoxVerdict judge(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::vector<Bound>& to,
                   OverlapCounts& counts) const {
    const Node &I = node_a(i), &J = node_b(j);
    return judge_.box({I, records_a_[I.middle]}, {J, records_b_[J.middle]}, from, to, counts);
  }

  void compare_all(std::uint32_t i, std::uint32_t j, std::span<const Bound> ties,
                   OverlapCandidates& out) const {
    const Node &I = node_a(i), &J = node_b(j);
    for (std::uint32_t k = I.begin; k < I.end; ++k)
      for (std::uint32_t l = J.begin; l < J.end; ++l) compare(k, l, ties, out);
  }

  /// The walk below a pair of boxes; `levels` holds the bounds of the boxes above.
  void walk(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::size_t depth,
            std::vector<std::vector<Bound>>& levels, OverlapCandidates& out) const {
    std::vector<Bound>& ties = levels[depth];
    ties.clear();
    const BoxVerdict verdict = judge(i, j, from, ties, out.counts);
    if (verdict == BoxVerdict::kInside || verdict == BoxVerdict::kCompare) {
      compare_all(i, j, ties, out);
    } else if (verdict == BoxVerdict::kSplitA) {
      walk(i + 1, j, ties, depth + 1, levels, out);
      walk(node_a(i).right, j, ties, depth + 1, levels, out);
    } else if (verdict == BoxVerdict::kSplitB) {
      walk(i, j + 1, ties, depth + 1, levels, out);
      walk(i, node_b(j).right, ties, depth + 1, levels, out);
    }
  }

  bool at_hand(const Node& I) const {
    return I.leaf() || view_.fits_at_hand(records_a_[I.begin], records_a_[I.end - 1]);
  }

  /// Opens boxes breadth-first until there are enough for the threads and each is at hand; what is settled on
  /// the way goes to `out`. In the order of a's poses.
  std::vector<Task> open(std::deque<Task> tasks, OverlapCandidates& out) const {
    std::vector<Task> ready;
    while (!tasks.empty()) {
      const Task task = std::move(tasks.front());
      tasks.pop_front();
      const bool is_at_hand = at_hand(node_a(task.node_a));
      if (is_at_hand && tasks.size() + ready.size() >= kTasks) {
        ready.push_back(task);
        continue;
      }
      std::vector<Bound> ties;
      BoxVerdict verdict = judge(task.node_a, task.node_b, task.ties, ties, out.counts);
      if (verdict == BoxVerdict::kInside || verdict == BoxVerdict::kCompare)
        compare_all(task.node_a, task.node_b, ties, out);
      if (verdict == BoxVerdict::kSplitB && !is_at_hand) verdict = BoxVerdict::kSplitA;
      if (verdict == BoxVerdict::kSplitA) {
        tasks.push_back({task.node_a + 1, task.node_b, ties});
        tasks.push_back({node_a(task.node_a).right, task.node_b, ties});
      } else if (verdict == BoxVerdict::kSplitB) {
        tasks.push_back({task.node_a, task.node_b + 1, ties});
        tasks.push_back({task.node_a, node_b(task.node_b).right, ties});
      }
    }
    std::stable_sort(ready.begin(), ready.end(), [&](const Task& x, const Task& y) {
      return node_a(x.node_a).begin < node_a(y.node_a).begin;
    });
    return ready;
  }

  std::uint32_t a_, b_;
  const std::vector<typename View::Record>&records_a_, &records_b_;
  View view_;
  Judge judge_;
  const OverlapTree<Pose>*tree_a_ = nullptr, *tree_b_ = nullptr;
};

/// Calls search(pair of robots, out of PairSearch) for every two robots, and puts the results in order.
template <OverlapSource Source, class Search>
OverlapCandidates over_team(const Source& source, const std::vector<OverlapSensor>& sensors,
                            const OverlapParams& params, Search&& search) {
  RADIOSLAM_CHECK(sensors.size() == source.robots(), "every robot has a sensor");
  OverlapCandidates all;
  for (std::uint32_t a = 0; a < source.robots(); ++a)
    for (std::uint32_t b = a + 1; b < source.robots(); ++b) {
      const OverlapRule rule{params.max_mahalanobis, overlap_distance(params), sensors[a], sensors[b]};
      PairSearch<Source> pair(source, a, b, rule);
      OverlapCandidates found = search(pair, a, b);
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
  return over_team(source, sensors, params, [&](auto& pair, std::uint32_t a, std::uint32_t b) {
    return pair.in_boxes(source, trees[a], trees[b]);
  });
}

template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params) {
  return over_team(source, sensors, params,
                   [&](auto& pair, std::uint32_t, std::uint32_t) { return pair.over_all(source); });
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

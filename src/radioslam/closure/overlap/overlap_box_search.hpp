// Overlap search between two robots by branch and bound over their trees of pose intervals
// (overlap_tree.hpp). The first levels are expanded breadth-first into tasks; each is then descended
// depth-first.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/overlap/overlap_bounds.hpp"

namespace radioslam {

/// Robots a and b, a listed first.
struct RobotPair {
  std::uint32_t a = 0, b = 0;
};

/// All links between two robots, without bounds.
template <OverlapView View>
std::vector<LinkBound<typename View::Pose>> all_ties(const View& view) {
  std::vector<LinkBound<typename View::Pose>> ties(view.ties());
  for (std::size_t t = 0; t < ties.size(); ++t) ties[t].tie = static_cast<std::uint32_t>(t);
  return ties;
}

/// Adds the results of a part of a search.
inline void append(OverlapCandidates& all, OverlapCandidates&& part) {
  all.counts += part.counts;
  if (all.candidates.capacity() == 0)
    all.candidates = std::move(part.candidates);
  else
    all.candidates.insert(all.candidates.end(), part.candidates.begin(), part.candidates.end());
}

/// Calls work(task, its own result) for every task in parallel and appends the results to `found` in order.
template <class Work>
OverlapCandidates gather_overlaps(std::size_t tasks, OverlapCandidates found, Work&& work) {
  std::vector<OverlapCandidates> parts(tasks);
  parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) work(t, parts[t]);
  });
  std::size_t kept = found.candidates.size();
  for (const auto& part : parts) kept += part.candidates.size();
  found.candidates.reserve(kept);
  for (auto& part : parts) append(found, std::move(part));
  return found;
}

/// Robot b's boxes and poses where all of them are at hand. A search through boxes that come from another
/// robot (overlap_exchange.hpp) waits for some.
template <OverlapView View>
class KnownBoxes {
 public:
  using Pose = typename View::Pose;
  using Record = typename View::Record;
  using Bound = LinkBound<Pose>;

  KnownBoxes(const OverlapTree<Pose>& tree, const std::vector<Record>& records)
      : tree_(tree), records_(records) {}

  const std::vector<typename OverlapTree<Pose>::Root>& roots() const { return tree_.roots; }
  const OverlapNode<Pose>& node(std::uint32_t j) const { return tree_.nodes[j]; }
  const Record& middle(std::uint32_t j) const { return records_[tree_.nodes[j].middle]; }
  const Record& record(std::uint32_t l) const { return records_[l]; }
  /// Whether box j's halves, or its poses, are known; if not, this box of a waits for them.
  bool has_halves(std::uint32_t, std::uint32_t, std::span<const Bound>) const { return true; }
  bool has_poses(std::uint32_t, std::uint32_t, std::span<const Bound>) const { return true; }

 private:
  const OverlapTree<Pose>& tree_;
  const std::vector<Record>& records_;
};

/// Keeps references to its arguments.
template <OverlapView View, class Boxes>
class OverlapBoxSearch {
 public:
  using Pose = typename View::Pose;
  using Tree = OverlapTree<Pose>;
  using Bound = LinkBound<Pose>;
  using Records = std::vector<typename View::Record>;

  OverlapBoxSearch(const View& view, const OverlapRule& rule, RobotPair robots, const Tree& tree_a,
                   const Records& records_a, Boxes& boxes_b)
      : view_(view),
        test_(view, rule),
        robots_(robots),
        tree_a_(tree_a),
        records_a_(records_a),
        boxes_b_(boxes_b) {}

  /// Through all boxes, on several threads.
  OverlapCandidates run() const {
    OverlapCandidates found;
    const std::vector<Task> tasks = open(first_tasks(), found);
    return gather_overlaps(tasks.size(), std::move(found), [&](std::size_t t, OverlapCandidates& out) {
      visit(tasks[t].node_a, tasks[t].node_b, tasks[t].ties, out);
    });
  }

  /// From all roots, in order.
  void visit_roots(OverlapCandidates& out) const {
    for (const Task& task : first_tasks()) visit(task.node_a, task.node_b, task.ties, out);
  }
  void visit(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, OverlapCandidates& out) const {
    std::vector<std::vector<Bound>> levels(kDeepest);
    descend(i, j, from, 0, levels, out);
  }
  void visit_halves(std::uint32_t i, std::uint32_t j, std::span<const Bound> from,
                    OverlapCandidates& out) const {
    for (const std::uint32_t half : {j + 1, boxes_b_.node(j).right}) visit(i, half, from, out);
  }
  void compare_all(std::uint32_t i, std::uint32_t j, std::span<const Bound> ties,
                   OverlapCandidates& out) const {
    const Node &I = tree_a_.nodes[i], &J = boxes_b_.node(j);
    for (std::uint32_t k = I.begin; k < I.end; ++k)
      for (std::uint32_t l = J.begin; l < J.end; ++l)
        test_.compare({robots_.a, robots_.b, k, l}, records_a_[k], boxes_b_.record(l), ties, out);
  }

 private:
  using Node = OverlapNode<Pose>;

  /// Pairs of boxes expanded before the work is distributed: enough for many threads, at negligible cost.
  static constexpr std::size_t kTasks = 512;
  /// Largest depth: two binary trees over 32-bit pose indices.
  static constexpr std::size_t kDeepest = 2 * 32 + 2;

  struct Task {
    std::uint32_t node_a, node_b;
    std::vector<Bound> ties;
  };

  std::deque<Task> first_tasks() const {
    std::deque<Task> tasks;
    if (view_.ties() == 0) return tasks;
    for (const auto& root_a : tree_a_.roots)
      for (const auto& root_b : boxes_b_.roots())
        if (root_a.component == root_b.component)
          tasks.push_back({root_a.node, root_b.node, all_ties(view_)});
    return tasks;
  }

  /// Tests a pair of boxes and appends their bounds to `ties`; then compares its poses, or calls
  /// child(i, j) for the two pairs of boxes that it is made of.
  template <class Child>
  void step(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::vector<Bound>& ties,
            OverlapCandidates& out, const Child& child) const {
    const Node &I = tree_a_.nodes[i], &J = boxes_b_.node(j);
    const BoxStatus status =
        test_.box({I, records_a_[I.middle]}, {J, boxes_b_.middle(j)}, from, ties, out.counts);
    if (status == BoxStatus::kInside || status == BoxStatus::kCompare) {
      if (boxes_b_.has_poses(i, j, ties)) compare_all(i, j, ties, out);
    } else if (status == BoxStatus::kSplitA) {
      child(i + 1, j);
      child(I.right, j);
    } else if (status == BoxStatus::kSplitB && boxes_b_.has_halves(i, j, ties)) {
      child(i, j + 1);
      child(i, J.right);
    }
  }

  /// Recursion below a pair of boxes; `levels` holds the bounds of the enclosing boxes.
  void descend(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::size_t depth,
               std::vector<std::vector<Bound>>& levels, OverlapCandidates& out) const {
    std::vector<Bound>& ties = levels[depth];
    ties.clear();
    step(i, j, from, ties, out, [&](std::uint32_t half_i, std::uint32_t half_j) {
      descend(half_i, half_j, ties, depth + 1, levels, out);
    });
  }

  /// Expands boxes breadth-first until there are enough tasks; pairs decided meanwhile go to `out`.
  std::vector<Task> open(std::deque<Task> tasks, OverlapCandidates& out) const {
    while (!tasks.empty() && tasks.size() < kTasks) {
      const Task task = std::move(tasks.front());
      tasks.pop_front();
      std::vector<Bound> ties;
      step(task.node_a, task.node_b, task.ties, ties, out, [&](std::uint32_t i, std::uint32_t j) {
        tasks.push_back({i, j, ties});
      });
    }
    return {std::make_move_iterator(tasks.begin()), std::make_move_iterator(tasks.end())};
  }

  const View& view_;
  OverlapTest<View> test_;
  RobotPair robots_;
  const Tree& tree_a_;
  const Records& records_a_;
  Boxes& boxes_b_;
};

}  // namespace radioslam

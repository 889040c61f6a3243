// Overlap search between two robots by branch and bound over their trees of pose intervals
// (overlap_tree.hpp). The first levels are expanded breadth-first into tasks; each is then descended
// depth-first.
#pragma once

#include <algorithm>
#include <deque>

#include "radioslam/closure/overlap/overlap_pair.hpp"

namespace radioslam {

/// Keeps references to its arguments.
template <OverlapSource Source>
class OverlapBoxSearch {
 public:
  using Pose = typename Source::View::Pose;
  using Tree = OverlapTree<Pose>;

  OverlapBoxSearch(const OverlapPair<Source>& pair, const Tree& A, const Tree& B)
      : pair_(pair), tree_a_(A), tree_b_(B) {}

  OverlapCandidates run(const Source& source) const {
    OverlapCandidates found;
    const std::vector<Task> tasks = open(first_tasks(source), found);
    return gather_overlaps(tasks.size(), std::move(found), [&](std::size_t t, OverlapCandidates& out) {
      std::vector<std::vector<Bound>> levels(kDeepest);
      descend(tasks[t].node_a, tasks[t].node_b, tasks[t].ties, 0, levels, out);
    });
  }

 private:
  using Bound = LinkBound<Pose>;
  using Node = OverlapNode<Pose>;

  /// Pairs of boxes expanded before the work is distributed: enough for many threads, at negligible cost.
  static constexpr std::size_t kTasks = 512;
  /// Largest depth: two binary trees over 32-bit pose indices.
  static constexpr std::size_t kDeepest = 2 * 32 + 2;

  struct Task {
    std::uint32_t node_a, node_b;
    std::vector<Bound> ties;
  };

  const Node& node_a(std::uint32_t i) const { return tree_a_.nodes[i]; }
  const Node& node_b(std::uint32_t j) const { return tree_b_.nodes[j]; }

  std::deque<Task> first_tasks(const Source& source) const {
    std::deque<Task> tasks;
    if (pair_.view().ties() == 0) return tasks;
    for (const auto& root_a : tree_a_.roots)
      for (const auto& root_b : tree_b_.roots)
        if (source.joined(pair_.a(), root_a.piece, pair_.b(), root_b.piece))
          tasks.push_back({root_a.node, root_b.node, pair_.all_ties()});
    return tasks;
  }

  BoxStatus test_boxes(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::vector<Bound>& to,
                       OverlapCounts& counts) const {
    const Node &I = node_a(i), &J = node_b(j);
    return pair_.test().box({I, pair_.records_a()[I.middle]}, {J, pair_.records_b()[J.middle]}, from, to,
                            counts);
  }

  void compare_all(std::uint32_t i, std::uint32_t j, std::span<const Bound> ties,
                   OverlapCandidates& out) const {
    const Node &I = node_a(i), &J = node_b(j);
    for (std::uint32_t k = I.begin; k < I.end; ++k)
      for (std::uint32_t l = J.begin; l < J.end; ++l) pair_.compare(k, l, ties, out);
  }

  /// Recursion below a pair of boxes; `levels` holds the bounds of the enclosing boxes.
  void descend(std::uint32_t i, std::uint32_t j, std::span<const Bound> from, std::size_t depth,
               std::vector<std::vector<Bound>>& levels, OverlapCandidates& out) const {
    std::vector<Bound>& ties = levels[depth];
    ties.clear();
    const BoxStatus status = test_boxes(i, j, from, ties, out.counts);
    if (status == BoxStatus::kInside || status == BoxStatus::kCompare) {
      compare_all(i, j, ties, out);
    } else if (status == BoxStatus::kSplitA) {
      descend(i + 1, j, ties, depth + 1, levels, out);
      descend(node_a(i).right, j, ties, depth + 1, levels, out);
    } else if (status == BoxStatus::kSplitB) {
      descend(i, j + 1, ties, depth + 1, levels, out);
      descend(i, node_b(j).right, ties, depth + 1, levels, out);
    }
  }

  /// Expands boxes breadth-first until there are enough tasks; pairs decided meanwhile go to `out`.
  std::vector<Task> open(std::deque<Task> tasks, OverlapCandidates& out) const {
    while (!tasks.empty() && tasks.size() < kTasks) {
      const Task task = std::move(tasks.front());
      tasks.pop_front();
      std::vector<Bound> ties;
      const BoxStatus status = test_boxes(task.node_a, task.node_b, task.ties, ties, out.counts);
      if (status == BoxStatus::kInside || status == BoxStatus::kCompare) {
        compare_all(task.node_a, task.node_b, ties, out);
      } else if (status == BoxStatus::kSplitA) {
        tasks.push_back({task.node_a + 1, task.node_b, ties});
        tasks.push_back({node_a(task.node_a).right, task.node_b, ties});
      } else if (status == BoxStatus::kSplitB) {
        tasks.push_back({task.node_a, task.node_b + 1, ties});
        tasks.push_back({task.node_a, node_b(task.node_b).right, ties});
      }
    }
    return {std::make_move_iterator(tasks.begin()), std::make_move_iterator(tasks.end())};
  }

  const OverlapPair<Source>& pair_;
  const Tree &tree_a_, &tree_b_;
};

}  // namespace radioslam

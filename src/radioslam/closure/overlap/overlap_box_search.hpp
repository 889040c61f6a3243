// Overlap search between two robots by branch and bound over their trees of pose intervals
// (overlap_tree.hpp). The first levels are expanded breadth-first into tasks; each is then descended
// depth-first.
#pragma once

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/overlap/overlap_bounds.hpp"

namespace radioslam {

// The overlap test between the poses of two robots, for the searches over all their pairs.

/// Two robots' poses and the test between them. Keeps references to the source.
template <OverlapSource Source>
class OverlapPair {
 public:
  using View = typename Source::View;
  using Pose = typename View::Pose;
  using Bound = LinkBound<Pose>;
  using Records = std::vector<typename View::Record>;

  OverlapPair(const Source& source, std::uint32_t a, std::uint32_t b, View view, const OverlapRule& rule)
      : a_(a),
        b_(b),
        records_a_(source.records(a)),
        records_b_(source.records(b)),
        view_(std::move(view)),
        test_(view_, rule) {}
  OverlapPair(const OverlapPair&) = delete;
  OverlapPair& operator=(const OverlapPair&) = delete;

  std::uint32_t a() const { return a_; }
  std::uint32_t b() const { return b_; }
  const Records& records_a() const { return records_a_; }
  const Records& records_b() const { return records_b_; }
  const View& view() const { return view_; }
  const OverlapTest<View>& test() const { return test_; }

  /// All links between the robots, without bounds.
  std::vector<Bound> all_ties() const {
    std::vector<Bound> ties(view_.ties());
    for (std::size_t t = 0; t < ties.size(); ++t) ties[t].tie = static_cast<std::uint32_t>(t);
    return ties;
  }

  /// Adds pose k of a and pose l of b to `out` if they are kept.
  void compare(std::uint32_t k, std::uint32_t l, std::span<const Bound> ties, OverlapCandidates& out) const {
    test_.compare({a_, b_, k, l}, records_a_[k], records_b_[l], ties, out);
  }

 private:
  std::uint32_t a_, b_;
  const Records &records_a_, &records_b_;
  View view_;
  OverlapTest<View> test_;
};

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

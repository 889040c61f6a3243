// The overlap test between the poses of two robots, for the searches over all their pairs.
#pragma once

#include <utility>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/overlap/overlap_bounds.hpp"

namespace radioslam {

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

}  // namespace radioslam

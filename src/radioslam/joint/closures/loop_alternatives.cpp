#include "radioslam/joint/closures/loop_alternatives.hpp"

#include <algorithm>
#include <map>

namespace radioslam {
namespace {

constexpr double kMinSupport = 1.5;             // sightings
constexpr double kMinRatioToAlternative = 1.5;  // of the evidence that a alternative contests to its own

/// The segments on the side of b when a join of the best choice is undone.
template <class Pose>
std::vector<bool> side_of_b(const std::vector<LoopGroup>& groups, const LoopAlignment<Pose>& best,
                            std::size_t join) {
  std::vector<bool> side(best.component.size(), false);
  side[groups[join].segment_b] = true;
  for (std::size_t round = 0; round < best.joins.size(); ++round)
    for (const std::size_t g : best.joins) {
      if (g == join) continue;
      const bool a = side[groups[g].segment_a], b = side[groups[g].segment_b];
      if (a != b) side[groups[g].segment_a] = side[groups[g].segment_b] = true;
    }
  return side;
}

/// Evidence of the groups that hold in `a` and not in `b`.
template <class Pose>
double contested(const std::vector<LoopGroup>& groups, const LoopAlignment<Pose>& a,
                 const LoopAlignment<Pose>& b) {
  double sum = 0;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (a.group_holds[g] && !b.group_holds[g]) sum += groups[g].evidence;
  return sum;
}

template <class Pose>
bool joins_sides(const std::vector<LoopGroup>& groups, const LoopAlignment<Pose>& alignment,
                 const std::vector<bool>& side) {
  return std::any_of(alignment.joins.begin(), alignment.joins.end(),
                     [&](std::size_t g) { return side[groups[g].segment_a] != side[groups[g].segment_b]; });
}

template <class Pose>
bool is_weak(const std::vector<LoopGroup>& groups, const std::vector<LoopAlignment<Pose>>& alignments,
             const std::vector<bool>& side) {
  const LoopAlignment<Pose>& best = alignments.front();
  double support = 0;
  std::vector<std::size_t> crossing;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (side[groups[g].segment_a] != side[groups[g].segment_b] && best.group_holds[g]) {
      support += groups[g].evidence;
      crossing.push_back(g);
    }
  if (support < kMinSupport) return true;
  return std::any_of(alignments.begin() + 1, alignments.end(), [&](const LoopAlignment<Pose>& alternative) {
    const auto holds = [&](std::size_t g) { return alternative.group_holds[g]; };
    return contradict_each_other(best, alternative) &&
           std::none_of(crossing.begin(), crossing.end(), holds) && joins_sides(groups, alternative, side) &&
           contested(groups, best, alternative) <
               kMinRatioToAlternative * contested(groups, alternative, best);
  });
}

}  // namespace

template <class Pose>
bool contradict_each_other(const LoopAlignment<Pose>& a, const LoopAlignment<Pose>& b) {
  const auto all_hold = [](const std::vector<std::size_t>& joins, const std::vector<bool>& holds) {
    return std::all_of(joins.begin(), joins.end(), [&](std::size_t g) { return holds[g]; });
  };
  return !all_hold(a.joins, b.group_holds) && !all_hold(b.joins, a.group_holds);
}

template <class Pose>
void undo_weak_joins(const std::vector<LoopGroup>& groups, std::vector<LoopAlignment<Pose>>& alignments) {
  LoopAlignment<Pose>& best = alignments.front();
  std::vector<std::vector<bool>> undone;
  std::vector<std::size_t> kept;
  for (const std::size_t join : best.joins) {
    std::vector<bool> side = side_of_b(groups, best, join);
    if (is_weak(groups, alignments, side))
      undone.push_back(std::move(side));
    else
      kept.push_back(join);
  }
  int next = *std::max_element(best.component.begin(), best.component.end()) + 1;
  for (const std::vector<bool>& side : undone) {
    std::map<int, int> renamed;
    for (std::size_t s = 0; s < side.size(); ++s)
      if (side[s]) {
        const auto [to, is_new] = renamed.try_emplace(best.component[s], next);
        if (is_new) ++next;
        best.component[s] = to->second;
      }
  }
  best.joins = kept;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (best.component[groups[g].segment_a] != best.component[groups[g].segment_b])
      best.group_holds[g] = false;
}

#define RADIOSLAM_LOOP_ALTERNATIVES(Pose)                                                      \
  template bool contradict_each_other(const LoopAlignment<Pose>&, const LoopAlignment<Pose>&); \
  template void undo_weak_joins(const std::vector<LoopGroup>&, std::vector<LoopAlignment<Pose>>&);
RADIOSLAM_LOOP_ALTERNATIVES(SE2)
RADIOSLAM_LOOP_ALTERNATIVES(SE3)
#undef RADIOSLAM_LOOP_ALTERNATIVES

}  // namespace radioslam

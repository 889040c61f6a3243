#include "radioslam/joint/closures/loop_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/base/evenly_chosen.hpp"
#include "radioslam/consistency/maximum_clique.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinUnweighted = 2;  // loops of a group with unit weights
constexpr std::size_t kMaxLoops = 600;     // per pair of segments, evenly chosen
constexpr double kMaxBranches = 2e5;       // of a search for the largest group

/// Path length of every pose along its segment.
template <class Pose>
std::vector<double> travelled_m(const JointGraph<Pose>& joint) {
  std::vector<double> travelled(joint.team.graph.poses.size(), 0);
  for (const TrajectorySegment& segment : joint.team.segments)
    for (std::size_t k = segment.first_pose + 1; k < segment.first_pose + segment.pose_count; ++k)
      travelled[k] =
          travelled[k - 1] +
          (joint.team.graph.poses[k].translation() - joint.team.graph.poses[k - 1].translation()).norm();
  return travelled;
}

/// Places seen: loops within `sighting_m` of another along both trajectories are one.
template <class Pose>
double evidence_of(const std::vector<TeamLoop<Pose>>& loops, const LoopGroup& group,
                   const std::vector<double>& travelled, double sighting_m) {
  struct Sighting {
    double at_a_m, at_b_m, loops;
  };
  std::vector<Sighting> sightings;
  for (const std::size_t k : group.loops) {
    const bool forward = loops[k].segment_i == group.segment_a;
    const double at_a_m = travelled[(forward ? loops[k].i : loops[k].j).index()],
                 at_b_m = travelled[(forward ? loops[k].j : loops[k].i).index()];
    const auto same = std::find_if(sightings.begin(), sightings.end(), [&](const Sighting& s) {
      return std::abs(s.at_a_m - at_a_m) < sighting_m && std::abs(s.at_b_m - at_b_m) < sighting_m;
    });
    if (same == sightings.end())
      sightings.push_back({at_a_m, at_b_m, 1});
    else
      ++same->loops;
  }
  double evidence = 0;
  for (const Sighting& s : sightings) evidence += 2 * s.loops / (s.loops + 1);
  return evidence;
}

}  // namespace

template <class Pose>
RelativePoseMatch<Pose> seen_from(const JointGraph<Pose>& joint, const TeamLoop<Pose>& loop, std::size_t a) {
  const auto& segments = joint.team.segments;
  const std::size_t i = loop.i.index() - segments[loop.segment_i].first_pose,
                    j = loop.j.index() - segments[loop.segment_j].first_pose;
  if (loop.segment_i == a) return {i, j, loop.T_i_j, loop.covariance};
  const UncertainPose<Pose> back = UncertainPose<Pose>{loop.T_i_j, loop.covariance}.inverse();
  return {j, i, back.pose, back.covariance};
}

template <class Pose>
std::vector<LoopGroup> loop_groups(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                                   const SegmentChains<Pose>& chains, const LoopGroupParams& params) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of_pair;
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (!loops[k].is_own()) of_pair[std::minmax(loops[k].segment_i, loops[k].segment_j)].push_back(k);
  const std::vector<double> travelled = travelled_m(joint);
  const auto length_m = [&](std::size_t segment) {
    const TrajectorySegment& of = joint.team.segments[segment];
    return travelled[of.first_pose + of.pose_count - 1];
  };
  const bool is_unweighted = has_unit_weights(params.consistency);
  const std::size_t max_groups = is_unweighted ? 1 : params.max_groups;
  std::vector<LoopGroup> groups;
  for (auto& [pair, all] : of_pair) {
    const auto [a, b] = pair;
    if (!are_enough(all.size(), params.consistency)) continue;
    std::vector<std::size_t> rest = evenly_chosen(std::move(all), kMaxLoops);
    std::vector<RelativePoseMatch<Pose>> matches;
    for (const std::size_t k : rest) matches.push_back(seen_from(joint, loops[k], a));
    const PairwiseConsistency pairs =
        pairwise_consistency(*chains[a], *chains[b], matches, pairwise_params(params.consistency));
    const std::vector<std::size_t> loop_of_vertex = rest;
    const double sighting_m =
        std::min(params.sighting_m, params.sighting_ratio * std::min(length_m(a), length_m(b)));
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = k;
    MaximumCliqueParams clique_params;
    clique_params.max_branches = kMaxBranches;
    for (std::size_t g = 0; g < max_groups && !rest.empty(); ++g) {
      const MaximumClique clique = maximum_clique(induced_graph(pairs.graph, rest), clique_params);
      if (is_unweighted && clique.vertices.size() < kMinUnweighted) break;
      LoopGroup group{a, b, {}, 0};
      for (const std::size_t member : clique.vertices) group.loops.push_back(loop_of_vertex[rest[member]]);
      for (auto it = clique.vertices.rbegin(); it != clique.vertices.rend(); ++it)
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(*it));
      group.evidence = evidence_of(loops, group, travelled, sighting_m);
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

#define RADIOSLAM_LOOP_GROUPS(Pose)                                                                        \
  template RelativePoseMatch<Pose> seen_from(const JointGraph<Pose>&, const TeamLoop<Pose>&, std::size_t); \
  template std::vector<LoopGroup> loop_groups(const JointGraph<Pose>&, const std::vector<TeamLoop<Pose>>&, \
                                              const SegmentChains<Pose>&, const LoopGroupParams&);
RADIOSLAM_LOOP_GROUPS(SE2)
RADIOSLAM_LOOP_GROUPS(SE3)
#undef RADIOSLAM_LOOP_GROUPS

namespace {

constexpr std::size_t kBeam = 64;  // choices of frames that are kept
const double kLogOddsPerSighting = std::log(5.0);

/// A measured relative pose that joins two frames.
template <class Pose>
struct FrameLink {
  std::size_t segment_a, segment_b;
  RelativePoseMatch<Pose> loop;
};

/// The pose of b's pose j from a's pose i along the links, to first order; nothing in different components.
template <class Pose>
std::optional<UncertainPose<Pose>> relative_pose(const SegmentChains<Pose>& chains,
                                                 const std::vector<FrameLink<Pose>>& links, std::size_t a,
                                                 std::size_t i, std::size_t b, std::size_t j) {
  struct Reached {
    std::size_t segment, pose;
    UncertainPose<Pose> from_i;
  };
  std::deque<Reached> queue{{a, i, {}}};
  std::vector<bool> seen(chains.size(), false);
  seen[a] = true;
  for (; !queue.empty(); queue.pop_front()) {
    const Reached at = queue.front();
    if (at.segment == b) return at.from_i * chains[b]->between(at.pose, j);
    for (const FrameLink<Pose>& link : links) {
      const bool forward = link.segment_a == at.segment;
      const std::size_t other = forward ? link.segment_b : link.segment_a;
      if ((!forward && link.segment_b != at.segment) || seen[other]) continue;
      seen[other] = true;
      const UncertainPose<Pose> step{link.loop.T_a_b, link.loop.covariance};
      const std::size_t leave = forward ? link.loop.pose_a : link.loop.pose_b;
      queue.push_back(
          {other, forward ? link.loop.pose_b : link.loop.pose_a,
           at.from_i * chains[at.segment]->between(at.pose, leave) * (forward ? step : step.inverse())});
    }
  }
  return std::nullopt;
}

template <class Pose>
struct Choice {
  LoopAlignment alignment;
  std::vector<FrameLink<Pose>> links;  ///< a tree per component
};

template <class Pose>
class FrameSearch {
 public:
  FrameSearch(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
              const std::vector<LoopGroup>& groups, const SegmentChains<Pose>& chains,
              const std::optional<RadioCovariance<Pose>>& radio)
      : joint_(joint), loops_(loops), groups_(groups), chains_(chains), radio_(radio) {}

  std::vector<LoopAlignment> run(const std::vector<int>& component) {
    std::vector<Choice<Pose>> beam{start(component)};
    for (const std::size_t g : strongest_first()) {
      std::vector<Choice<Pose>> next;
      for (Choice<Pose>& choice : beam) extend(std::move(choice), g, next);
      keep_best(next);
      beam = std::move(next);
    }
    for (Choice<Pose>& choice : beam) weigh(choice);
    keep_best(beam);
    std::vector<LoopAlignment> result;
    for (Choice<Pose>& choice : beam) {
      const auto is_same = [&](const LoopAlignment& other) {
        return other.group_holds == choice.alignment.group_holds;
      };
      if (std::none_of(result.begin(), result.end(), is_same)) result.push_back(std::move(choice.alignment));
    }
    return result;
  }

 private:
  std::vector<std::size_t> strongest_first() const {
    std::vector<std::size_t> order(groups_.size());
    for (std::size_t g = 0; g < order.size(); ++g) order[g] = g;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return groups_[x].evidence > groups_[y].evidence; });
    return order;
  }

  /// Segments that share a frame already are linked as they are.
  Choice<Pose> start(const std::vector<int>& component) const {
    Choice<Pose> choice;
    choice.alignment.component = component;
    choice.alignment.group_holds.assign(groups_.size(), false);
    std::vector<PoseId> end(component.size());  // of a loop, per segment
    for (const TeamLoop<Pose>& loop : loops_)
      if (!loop.is_own()) end[loop.segment_i] = loop.i, end[loop.segment_j] = loop.j;
    std::map<int, std::size_t> first;
    for (std::size_t s = 0; s < component.size(); ++s) {
      if (!end[s].valid()) continue;
      const auto [with, is_first] = first.try_emplace(component[s], s);
      if (is_first) continue;
      const auto& poses = joint_.team.graph.poses;
      const PoseId i = end[with->second], j = end[s];
      choice.links.push_back(
          {with->second,
           s,
           {i.index() - joint_.team.segments[with->second].first_pose,
            j.index() - joint_.team.segments[s].first_pose, poses[i.index()].inverse() * poses[j.index()],
            radio_ ? radio_->relative_pose(i, j) : Pose::Jacobian::Zero()}});
    }
    return choice;
  }

  void extend(Choice<Pose> choice, std::size_t g, std::vector<Choice<Pose>>& next) const {
    const LoopGroup& group = groups_[g];
    LoopAlignment& alignment = choice.alignment;
    if (alignment.component[group.segment_a] != alignment.component[group.segment_b]) {
      next.push_back(choice);
      join(choice, g);
      alignment.log_weight += kLogOddsPerSighting * group.evidence;
    } else if (holds(choice, g)) {
      alignment.log_weight += kLogOddsPerSighting * group.evidence;
    }
    next.push_back(std::move(choice));
  }

  void join(Choice<Pose>& choice, std::size_t g) const {
    const LoopGroup& group = groups_[g];
    std::vector<int>& component = choice.alignment.component;
    std::replace(component.begin(), component.end(), int(component[group.segment_b]),
                 int(component[group.segment_a]));
    choice.links.push_back(
        {group.segment_a, group.segment_b, seen_from(joint_, loops_[group.middle()], group.segment_a)});
    choice.alignment.joins.push_back(g);
  }

  bool holds(const Choice<Pose>& choice, std::size_t g) const {
    const LoopGroup& group = groups_[g];
    const auto loop = seen_from(joint_, loops_[group.middle()], group.segment_a);
    const auto by_frames =
        relative_pose(chains_, choice.links, group.segment_a, loop.pose_a, group.segment_b, loop.pose_b);
    if (!by_frames) return false;
    const Cholesky<typename Pose::Jacobian> cholesky(by_frames->covariance + loop.covariance);
    const typename Pose::Tangent error = (loop.T_a_b.inverse() * by_frames->pose).log();
    return cholesky.succeeded() && cholesky.whitened(error).squaredNorm() <= kPoseChiSquared999<Pose>;
  }

  /// By all groups: those that could not be compared when it was their turn, too.
  void weigh(Choice<Pose>& choice) const {
    choice.alignment.log_weight = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      choice.alignment.group_holds[g] = holds(choice, g);
      if (choice.alignment.group_holds[g])
        choice.alignment.log_weight += kLogOddsPerSighting * groups_[g].evidence;
    }
  }

  static void keep_best(std::vector<Choice<Pose>>& choices) {
    std::stable_sort(choices.begin(), choices.end(), [](const auto& x, const auto& y) {
      return x.alignment.log_weight > y.alignment.log_weight;
    });
    if (choices.size() > kBeam) choices.erase(choices.begin() + kBeam, choices.end());
  }

  const JointGraph<Pose>& joint_;
  const std::vector<TeamLoop<Pose>>& loops_;
  const std::vector<LoopGroup>& groups_;
  const SegmentChains<Pose>& chains_;
  const std::optional<RadioCovariance<Pose>>& radio_;
};

}  // namespace

template <class Pose>
std::vector<LoopAlignment> align_by_loops(const JointGraph<Pose>& joint, const std::vector<int>& component,
                                          const std::vector<TeamLoop<Pose>>& loops,
                                          const std::vector<LoopGroup>& groups,
                                          const SegmentChains<Pose>& chains,
                                          const std::optional<RadioCovariance<Pose>>& radio) {
  return FrameSearch<Pose>(joint, loops, groups, chains, radio).run(component);
}

template <class Pose>
Pose motion_to_hold(const std::vector<Pose>& poses, const TeamLoop<Pose>& loop, std::size_t moved) {
  const Pose &at_i = poses[loop.i.index()], &at_j = poses[loop.j.index()];
  return loop.segment_j == moved ? at_i * loop.T_i_j * at_j.inverse()
                                 : at_j * loop.T_i_j.inverse() * at_i.inverse();
}

template <class Pose>
std::vector<Pose> joined(const JointGraph<Pose>& joint, std::vector<Pose> poses,
                         const std::vector<TeamLoop<Pose>>& loops, const std::vector<LoopGroup>& groups,
                         const std::vector<std::size_t>& joins, std::vector<int> component,
                         const std::vector<bool>& stays) {
  const auto must_stay = [&](std::size_t segment) {
    const auto c = static_cast<std::size_t>(component[segment]);
    return c < stays.size() && stays[c];
  };
  for (const std::size_t g : joins) {
    std::size_t fixed = groups[g].segment_a, moved = groups[g].segment_b;
    if (must_stay(moved)) std::swap(fixed, moved);
    const Pose T = motion_to_hold(poses, loops[groups[g].middle()], moved);
    const int from = component[moved], to = component[fixed];
    for (std::size_t s = 0; s < component.size(); ++s)
      if (component[s] == from) {
        component[s] = to;
        move_segment(poses, joint.team.segments[s], T);
      }
  }
  return poses;
}

#define RADIOSLAM_LOOP_ALIGNMENT(Pose)                                                                 \
  template std::vector<LoopAlignment> align_by_loops(                                                  \
      const JointGraph<Pose>&, const std::vector<int>&, const std::vector<TeamLoop<Pose>>&,            \
      const std::vector<LoopGroup>&, const SegmentChains<Pose>&,                                       \
      const std::optional<RadioCovariance<Pose>>&);                                                    \
  template Pose motion_to_hold(const std::vector<Pose>&, const TeamLoop<Pose>&, std::size_t);          \
  template std::vector<Pose> joined(const JointGraph<Pose>&, std::vector<Pose>,                        \
                                    const std::vector<TeamLoop<Pose>>&, const std::vector<LoopGroup>&, \
                                    const std::vector<std::size_t>&, std::vector<int>,                 \
                                    const std::vector<bool>&);
RADIOSLAM_LOOP_ALIGNMENT(SE2)
RADIOSLAM_LOOP_ALIGNMENT(SE3)
#undef RADIOSLAM_LOOP_ALIGNMENT

namespace {

constexpr double kMinRatioToAlternative = 1.5;  // of the evidence that a alternative contests to its own

/// The segments on the side of b when a join of the best choice is undone.
std::vector<bool> side_of_b(const std::vector<LoopGroup>& groups, const LoopAlignment& best,
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
double contested(const std::vector<LoopGroup>& groups, const LoopAlignment& a, const LoopAlignment& b) {
  double sum = 0;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (a.group_holds[g] && !b.group_holds[g]) sum += groups[g].evidence;
  return sum;
}

bool joins_sides(const std::vector<LoopGroup>& groups, const LoopAlignment& alignment,
                 const std::vector<bool>& side) {
  return std::any_of(alignment.joins.begin(), alignment.joins.end(),
                     [&](std::size_t g) { return side[groups[g].segment_a] != side[groups[g].segment_b]; });
}

bool is_weak(const std::vector<LoopGroup>& groups, const std::vector<LoopAlignment>& alignments,
             const std::vector<bool>& side, double min_support) {
  const LoopAlignment& best = alignments.front();
  double support = 0;
  std::vector<std::size_t> crossing;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (side[groups[g].segment_a] != side[groups[g].segment_b] && best.group_holds[g]) {
      support += groups[g].evidence;
      crossing.push_back(g);
    }
  if (support < min_support) return true;
  return std::any_of(alignments.begin() + 1, alignments.end(), [&](const LoopAlignment& alternative) {
    const auto holds = [&](std::size_t g) { return alternative.group_holds[g]; };
    return contradict_each_other(best, alternative) &&
           std::none_of(crossing.begin(), crossing.end(), holds) && joins_sides(groups, alternative, side) &&
           contested(groups, best, alternative) <
               kMinRatioToAlternative * contested(groups, alternative, best);
  });
}

}  // namespace

bool contradict_each_other(const LoopAlignment& a, const LoopAlignment& b) {
  const auto all_hold = [](const std::vector<std::size_t>& joins, const std::vector<bool>& holds) {
    return std::all_of(joins.begin(), joins.end(), [&](std::size_t g) { return holds[g]; });
  };
  return !all_hold(a.joins, b.group_holds) && !all_hold(b.joins, a.group_holds);
}

void undo_weak_joins(const std::vector<LoopGroup>& groups, const std::vector<std::size_t>& robot_of_segment,
                     std::vector<LoopAlignment>& alignments) {
  LoopAlignment& best = alignments.front();
  std::vector<std::vector<bool>> undone;
  std::vector<std::size_t> kept;
  for (const std::size_t join : best.joins) {
    std::vector<bool> side = side_of_b(groups, best, join);
    const bool is_own = robot_of_segment[groups[join].segment_a] == robot_of_segment[groups[join].segment_b];
    if (is_weak(groups, alignments, side, is_own ? kMinOwnSupport : kMinSupport))
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

}  // namespace radioslam

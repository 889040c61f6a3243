#include "radioslam/joint/closures/loop_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "radioslam/joint/closures/loop_alignment.hpp"
#include "radioslam/joint/closures/loop_selection.hpp"
#include "radioslam/joint/closures/own_loops.hpp"
#include "radioslam/joint/closures/team_loops.hpp"
#include "radioslam/joint/places/map_witness.hpp"

namespace radioslam {
namespace {

constexpr double kMinAlternative = 0.001;  // weight
constexpr std::size_t kMaxAlternatives = 3;
constexpr double kNotableScale = 1.5;  // of a standard deviation
/// With the odometry's sigma, twice and four times that: it is often understated.
constexpr int kMaxPasses = 3;

template <class Pose>
void add_accepted(JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                  const std::vector<Closure>& closures) {
  for (const TeamLoop<Pose>& loop : loops) {
    if (!loop.accepted) continue;
    const std::size_t first = loop.closures.front();
    add_closure(joint, closures[first], loop_factor(loop), FactorSource::kLoop, first);
  }
}

/// Takes the robots' own loops out of the graph; those that were in it are accepted so far.
template <class Pose>
void take_out(JointGraph<Pose>& joint, std::vector<TeamLoop<Pose>>& loops) {
  for (std::size_t k = 0; k < joint.origins.relative_poses.size(); ++k) {
    const FactorOrigin& origin = joint.origins.relative_poses[k];
    if (origin.source != FactorSource::kLoop) continue;
    for (TeamLoop<Pose>& loop : loops)
      if (loop.closures.front() == origin.measurement) loop.accepted = true;
  }
  erase_relative_poses(joint, [](const FactorOrigin& o) { return o.source == FactorSource::kLoop; });
}

template <class Pose>
void scale_odometry(JointGraph<Pose>& joint, double scale) {
  for (const std::size_t k : factors_of(joint.origins.relative_poses, FactorSource::kOdometry))
    joint.team.graph.relative_poses[k].information /= scale * scale;
}

/// The robots' components after loops have joined those of segments.
template <class Pose>
void join_components(const JointGraph<Pose>& joint, const std::vector<int>& of_segment,
                     TeamAlignment<Pose>& alignment) {
  std::vector<bool> absolute_before;
  for (const int c : alignment.component)
    absolute_before.push_back(alignment.absolute[static_cast<std::size_t>(c)]);
  set_components(joint, of_segment, alignment);
  alignment.absolute.assign(alignment.component.size(), false);
  for (std::size_t r = 0; r < alignment.component.size(); ++r)
    if (absolute_before[r]) alignment.absolute[static_cast<std::size_t>(alignment.component[r])] = true;
  set_placed(alignment);
}

template <class Pose>
std::vector<Pose> moved(const JointGraph<Pose>& joint, const LoopAlignment<Pose>& alignment) {
  std::vector<Pose> poses = joint.team.graph.poses;
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s)
    move_segment(poses, joint.team.segments[s], alignment.T_frame_segment[s]);
  return poses;
}

/// Whether two solutions accept the same loops between trajectories, but for a tenth.
template <class Pose>
bool accept_the_same(const std::vector<TeamLoop<Pose>>& a, const std::vector<TeamLoop<Pose>>& b) {
  std::size_t accepted = 0, different = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].is_own()) continue;
    if (a[k].accepted) ++accepted;
    if (a[k].accepted != b[k].accepted) ++different;
  }
  return 10 * different <= accepted;
}

template <class Pose>
void accept_groups(const std::vector<LoopGroup>& groups, const LoopAlignment<Pose>& alignment,
                   std::vector<TeamLoop<Pose>>& loops) {
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (alignment.group_holds[g])
      for (const std::size_t k : groups[g].loops) loops[k].accepted = true;
}

/// Alignments that join as many robots as the best and are solved to another end, with their weights.
/// `joint` and `loops`: before the best one is solved; `solved`: after.
template <class Pose>
void set_alternatives(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                      const std::vector<TeamLoop<Pose>>& solved, const std::vector<LoopGroup>& groups,
                      const std::vector<LoopAlignment<Pose>>& alignments, const OptimizerParams& optimizer,
                      TeamAlignment<Pose>& alignment) {
  const LoopAlignment<Pose>& best = alignments.front();
  std::vector<double> weights{1};
  alignment.alternatives.clear();
  for (std::size_t k = 1; k < alignments.size() && weights.size() <= kMaxAlternatives; ++k) {
    const double weight = std::exp(alignments[k].log_weight - best.log_weight);
    if (weight < kMinAlternative) break;
    if (alignments[k].joins.size() < best.joins.size() || !contradict_each_other(best, alignments[k]))
      continue;
    JointGraph<Pose> other = joint;
    std::vector<TeamLoop<Pose>> its_loops = loops;
    accept_groups(groups, alignments[k], its_loops);
    other.team.graph.poses = moved(joint, alignments[k]);
    select_loops(other, alignments[k].component, its_loops, optimizer, {});
    if (accept_the_same(solved, its_loops)) continue;
    alignment.alternatives.push_back(std::move(other.team.graph.poses));
    weights.push_back(weight);
  }
  double sum = 0;
  for (const double w : weights) sum += w;
  alignment.weight = weights.front() / sum;
  alignment.alternative_weights.clear();
  for (std::size_t k = 1; k < weights.size(); ++k) alignment.alternative_weights.push_back(weights[k] / sum);
}

constexpr std::size_t kMinHeld = 1000;  // points that were compared
constexpr double kMaxThrough = 0.4;     // share of points seen through, however the world is made
/// The same against the group of the pair that lays the maps best.
constexpr double kMaxOverBest = 3, kMaxBeyondBest = 0.02;

/// Without groups that could join robots but lay one's structure into the other's free space.
template <class Pose>
std::vector<LoopGroup> held_against_maps(const MapWitness* maps, const std::vector<Closure>& closures,
                                         const std::vector<TeamLoop<Pose>>& loops,
                                         std::vector<LoopGroup> groups) {
  if (!maps) return groups;
  std::vector<std::optional<double>> through;  // per group
  std::map<std::pair<std::size_t, std::size_t>, double> least;
  for (const LoopGroup& group : groups) {
    through.emplace_back();
    if (group.evidence < kMinSupport) continue;
    std::vector<const Closure*> members;
    for (const std::size_t k : group.loops) members.push_back(&closures[loops[k].closures.front()]);
    const SeenThrough held = maps->held_against(members);
    if (held.all() < kMinHeld) continue;
    through.back() = held.share();
    double& best = least.try_emplace({group.segment_a, group.segment_b}, 1).first->second;
    best = std::min(best, held.share());
  }
  std::size_t k = 0;
  std::erase_if(groups, [&](const LoopGroup& group) {
    const std::optional<double> share = through[k++];
    if (!share) return false;
    const double best = least.at({group.segment_a, group.segment_b});
    return *share > kMaxThrough || *share > kMaxOverBest * best + kMaxBeyondBest;
  });
  return groups;
}

/// Components of segments that were apart, joined by the accepted loops between them.
template <class Pose>
std::vector<int> joined_by_accepted(std::vector<int> component, const std::vector<TeamLoop<Pose>>& loops) {
  for (const TeamLoop<Pose>& loop : loops)
    if (loop.accepted)
      std::replace(component.begin(), component.end(), int(component[loop.segment_j]),
                   int(component[loop.segment_i]));
  return component;
}

/// The choice as the user reads it.
template <class Pose>
LoopChoiceResult described(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                           const LoopSelection& selection) {
  LoopChoiceResult result{selection.cost, {}};
  for (const ValleyTrial& trial : selection.trials) {
    const TeamLoop<Pose>& first = loops[trial.loops.front()];
    LoopTrialResult described{{}, trial.loops.size(), trial.fate == Fate::kHolds, trial.cost, trial.taken};
    for (const std::size_t segment : {first.segment_i, first.segment_j}) {
      const std::string& robot = joint.robots[joint.robot_of_segment[segment]].id;
      if (described.robots.empty() || described.robots.front() != robot) described.robots.push_back(robot);
    }
    result.trials.push_back(std::move(described));
  }
  return result;
}

/// Names of the robots of a group, and what of their loops agrees.
template <class Pose>
struct GroupText {
  std::string robots, counts;

  GroupText(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops, const LoopGroup& group)
      : robots(robot(joint, group.segment_a) + " and " + robot(joint, group.segment_b)) {
    const auto all = std::count_if(loops.begin(), loops.end(), [&](const TeamLoop<Pose>& loop) {
      return std::minmax(loop.segment_i, loop.segment_j) == std::minmax(group.segment_a, group.segment_b);
    });
    counts = std::to_string(group.loops.size()) + " of " + std::to_string(all);
  }

 private:
  static const std::string& robot(const JointGraph<Pose>& joint, std::size_t segment) {
    return joint.robots[joint.robot_of_segment[segment]].id;
  }
};

/// What the frame stands on, and what loops leave open: the largest group of every pair.
template <class Pose>
void note_groups(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                 const std::vector<LoopGroup>& groups, const LoopAlignment<Pose>& best,
                 const std::string& measured, TeamAlignment<Pose>& alignment) {
  const LoopGroup* weakest = nullptr;
  std::set<std::size_t> robots;
  std::set<std::string> parts;  // robots with parts that a single sighting ties to the rest
  for (const std::size_t g : best.joins) {
    const std::size_t a = joint.robot_of_segment[groups[g].segment_a],
                      b = joint.robot_of_segment[groups[g].segment_b];
    if (best.component[groups[g].segment_a] != best.component[groups[g].segment_b]) continue;
    if (a == b && groups[g].evidence < kMinSupport) parts.insert(joint.robots[a].id);
    if (a == b) continue;
    robots.insert({a, b});
    if (!weakest || groups[g].evidence < weakest->evidence) weakest = &groups[g];
  }
  if (weakest) {
    const GroupText<Pose> text(joint, loops, *weakest);
    alignment.notes.push_back("the common frame of " + std::to_string(robots.size()) + " robots stands on " +
                              measured + " alone; least supported is the relative pose of " + text.robots +
                              ": " + text.counts + " agree with one another");
  }
  for (const std::string& robot : parts)
    alignment.notes.push_back("what robot " + robot + " has behind a gap of its odometry stands on " +
                              measured + " of a single place");
  std::set<std::pair<std::size_t, std::size_t>> noted;
  for (const LoopGroup& group : groups) {
    const auto pair =
        std::make_pair(joint.robot_of_segment[group.segment_a], joint.robot_of_segment[group.segment_b]);
    const bool is_open = best.component[group.segment_a] != best.component[group.segment_b];
    if (!is_open || pair.first == pair.second || !noted.insert(pair).second) continue;
    const GroupText<Pose> text(joint, loops, group);
    alignment.notes.push_back(measured + " leave the relative pose of " + text.robots +
                              " open: the largest group that agrees has " + text.counts);
  }
}

std::string factor_text(double scale) {
  const double rounded = std::round(scale * 10) / 10;
  std::string text = std::to_string(rounded);
  text.resize(text.find('.') + 2);
  return text;
}

template <class Pose>
void note_scales(const LoopSelection& selection, TeamAlignment<Pose>& alignment) {
  const auto note = [&](const std::string& what, double scale) {
    if (scale < kNotableScale && scale > 1 / kNotableScale) return;
    alignment.notes.push_back(
        "the errors of " + what + " are " + factor_text(scale) +
        " times as large as their stated covariances allow; the estimate uses the actual ones");
  };
  note("the odometry", selection.odometry_scale);
  note("loop closures", selection.loop_scale);
}

}  // namespace

template <class Pose>
void add_own_loops(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                   const OptimizerParams& optimizer) {
  std::vector<TeamLoop<Pose>> loops = team_loops(joint, closures);
  correct_by_own_loops(joint, loops, optimizer);
  add_accepted(joint, loops, closures);
}

template <class Pose>
std::optional<LoopChoiceResult> close_by_loops(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                                               const std::vector<Closure>& closures,
                                               std::vector<ClosureJudgement>& judgements,
                                               const OptimizerParams& optimizer, const Progress& progress,
                                               const ConsistencyParams& consistency, const MapWitness* maps) {
  for (std::size_t k = 0; k < closures.size(); ++k)
    if (!closure_ends(joint, closures[k]).valid()) reject(judgements[k], "no odometry at its time");
  std::vector<TeamLoop<Pose>> loops = team_loops(joint, closures);
  if (loops.empty()) return std::nullopt;
  take_out(joint, loops);
  const std::vector<int> component_before = alignment.of_segment;
  LoopSelection scales;
  LoopChoiceResult choice;
  std::vector<int> component;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const double odometry_scale = std::max(scales.odometry_scale, std::pow(2.0, pass));
    const auto chains = segment_chains(joint, loops, odometry_scale);
    const auto groups = held_against_maps(maps, closures, loops,
                                          loop_groups(joint, loops, chains, {.consistency = consistency}));
    auto alignments = align_by_loops(joint, component_before, loops, groups, chains);
    if (!has_unit_weights(consistency)) undo_weak_joins(groups, joint.robot_of_segment, alignments);
    const JointGraph<Pose> before = joint;
    const std::vector<TeamLoop<Pose>> loops_before = loops;
    component = alignments.front().component;
    accept_groups(groups, alignments.front(), loops);
    joint.team.graph.poses = moved(joint, alignments.front());
    const LoopSelection selection = select_loops(joint, component, loops, optimizer, progress);
    set_alternatives(before, loops_before, loops, groups, alignments, optimizer, alignment);
    choice = described(joint, loops, selection);
    scales.odometry_scale = selection.odometry_scale;
    scales.loop_scale *= selection.loop_scale;
    for (TeamLoop<Pose>& loop : loops) loop.covariance *= selection.loop_scale * selection.loop_scale;
    const bool is_open = std::any_of(loops.begin(), loops.end(), [&](const TeamLoop<Pose>& loop) {
      return component[loop.segment_i] != component[loop.segment_j];
    });
    if (is_open && pass + 1 < kMaxPasses) continue;
    component = alignments.front().component = joined_by_accepted(component_before, loops);
    const std::string measured = closures.front().kind == ClosureKind::kMatch ? "matches" : "loop closures";
    note_groups(joint, loops, groups, alignments.front(), measured, alignment);
    break;
  }
  join_components(joint, component, alignment);
  scale_odometry(joint, scales.odometry_scale);
  add_accepted(joint, loops, closures);
  optimize(joint.team.graph, optimizer, progress);
  for (const TeamLoop<Pose>& loop : loops)
    for (const std::size_t k : loop.closures) {
      judgements[k].statistic = loop.statistic;
      if (loop.accepted) continue;
      const bool open = component[loop.segment_i] != component[loop.segment_j];
      reject(judgements[k], open ? "no group of loops stands out" : "the joint estimate disagrees");
    }
  note_scales(scales, alignment);
  return choice;
}

#define RADIOSLAM_LOOP_STAGE(Pose)                                                                          \
  template void add_own_loops(JointGraph<Pose>&, const std::vector<Closure>&, const OptimizerParams&);      \
  template std::optional<LoopChoiceResult> close_by_loops(                                                  \
      JointGraph<Pose>&, TeamAlignment<Pose>&, const std::vector<Closure>&, std::vector<ClosureJudgement>&, \
      const OptimizerParams&, const Progress&, const ConsistencyParams&, const MapWitness*);
RADIOSLAM_LOOP_STAGE(SE2)
RADIOSLAM_LOOP_STAGE(SE3)
#undef RADIOSLAM_LOOP_STAGE

}  // namespace radioslam

#include "radioslam/joint/closures/loop_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/loop_alignment.hpp"
#include "radioslam/joint/closures/loop_selection.hpp"
#include "radioslam/joint/closures/map_contradictions.hpp"
#include "radioslam/joint/closures/own_loops.hpp"
#include "radioslam/joint/closures/team_loops.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/segment_odometry.hpp"

namespace radioslam {
namespace {

constexpr double kMinAlternative = 0.001;  // weight
constexpr std::size_t kMaxAlternatives = 3;
constexpr double kNotableScale = 1.5;  // of a standard deviation
/// With the odometry's sigma, twice and four times that: it is often understated.
constexpr int kMaxPasses = 3;
constexpr int kReweighings = 3;
constexpr std::size_t kMinContradicting = 3;  // loops of two robots that may contradict their links

bool is_notable(double scale) { return scale >= kNotableScale || scale <= 1 / kNotableScale; }

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
  const std::vector<bool> is_ordinary = ordinary_steps(joint);
  for (const std::size_t k : factors_of(joint.origins.relative_poses, FactorSource::kOdometry)) {
    const double of_step = scale_of_step(is_ordinary[k], scale);
    joint.team.graph.relative_poses[k].information /= of_step * of_step;
  }
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
void accept_groups(const std::vector<LoopGroup>& groups, const LoopAlignment& alignment,
                   std::vector<TeamLoop<Pose>>& loops) {
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (alignment.group_holds[g])
      for (const std::size_t k : groups[g].loops) loops[k].accepted = true;
}

/// Loops, their groups, and what the robots' frames were before.
template <class Pose>
struct Frames {
  std::vector<int> component;  ///< per segment; all in the common frame are one
  std::vector<bool> stays;     ///< per component
  std::vector<LoopGroup> groups;

  std::vector<Pose> moved(const JointGraph<Pose>& joint, std::vector<Pose> poses,
                          const std::vector<TeamLoop<Pose>>& loops, const LoopAlignment& to) const {
    return joined(joint, std::move(poses), loops, groups, to.joins, component, stays);
  }
};

template <class Pose>
Frames<Pose> frames_of(const TeamAlignment<Pose>& alignment) {
  Frames<Pose> frames{alignment.of_segment, alignment.absolute, {}};
  std::optional<int> common;
  for (int& c : frames.component) {
    const auto k = static_cast<std::size_t>(c);
    if (k < frames.stays.size() && frames.stays[k]) c = common.value_or(c), common = c;
  }
  return frames;
}

/// Alignments that join as many robots as the best and are solved to another end, with their weights.
/// `joint` and `loops`: before the best one is solved; `solved`: after.
template <class Pose>
void set_alternatives(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                      const std::vector<TeamLoop<Pose>>& solved, const Frames<Pose>& frames,
                      const std::vector<LoopAlignment>& alignments, const OptimizerParams& optimizer,
                      TeamAlignment<Pose>& alignment) {
  const LoopAlignment& best = alignments.front();
  std::vector<double> weights{1};
  alignment.alternatives.clear();
  for (std::size_t k = 1; k < alignments.size() && weights.size() <= kMaxAlternatives; ++k) {
    const double weight = std::exp(alignments[k].log_weight - best.log_weight);
    if (weight < kMinAlternative) break;
    if (alignments[k].joins.size() < best.joins.size() || !contradict_each_other(best, alignments[k]))
      continue;
    JointGraph<Pose> other = joint;
    std::vector<TeamLoop<Pose>> its_loops = loops;
    accept_groups(frames.groups, alignments[k], its_loops);
    other.team.graph.poses = frames.moved(joint, joint.team.graph.poses, loops, alignments[k]);
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

/// Appends the solutions of nearly the same cost that accept other loops; they share the best one's weight.
template <class Pose>
void append_valleys(const LoopSelection<Pose>& selection, TeamAlignment<Pose>& alignment) {
  const double scale = std::max({1.0, selection.odometry_scale, selection.loop_scale});
  const double best = alignment.weight;
  double sum = 1;
  std::vector<double> shares;
  for (const OtherValley<Pose>& other : selection.valleys.others) {
    const double share = std::exp(std::min(0.0, selection.cost - other.cost) / (2 * scale * scale));
    if (share < kMinAlternative || alignment.alternatives.size() >= kMaxAlternatives) break;
    alignment.alternatives.push_back(other.poses);
    shares.push_back(share);
    sum += share;
  }
  alignment.weight = best / sum;
  for (const double share : shares) alignment.alternative_weights.push_back(best * share / sum);
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
                           const LoopSelection<Pose>& selection) {
  LoopChoiceResult result{selection.cost, {}};
  for (const ValleyTrial& trial : selection.valleys.trials) {
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
                 const std::vector<LoopGroup>& groups, const LoopAlignment& best, const std::string& measured,
                 TeamAlignment<Pose>& alignment) {
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
void note_scales(const LoopSelection<Pose>& selection, TeamAlignment<Pose>& alignment) {
  const auto note = [&](const std::string& what, double scale) {
    if (!is_notable(scale)) return;
    alignment.notes.push_back(
        "the errors of " + what + " are " + factor_text(scale) +
        " times as large as their stated covariances allow; the estimate uses the actual ones");
  };
  note("the odometry", selection.odometry_scale);
  note("loop closures", selection.loop_scale);
}

/// A team solved with the loops that hold.
template <class Pose>
struct LoopSolution {
  JointGraph<Pose> joint;
  std::vector<TeamLoop<Pose>> loops;
  LoopSelection<Pose> selection;
  double log_likelihood = 0;  ///< of a team with links
};

/// Pairs of robots with enough loops that hold to determine their relative pose.
template <class Pose>
PairsOfRobots pairs_with_loops(const LoopSolution<Pose>& solution) {
  std::map<std::pair<RobotIndex, RobotIndex>, std::size_t> held;
  const auto robot = [&](std::size_t segment) {
    return RobotIndex(solution.joint.robot_of_segment[segment]);
  };
  for (const TeamLoop<Pose>& loop : solution.loops)
    if (loop.accepted && robot(loop.segment_i) != robot(loop.segment_j))
      ++held[std::minmax(robot(loop.segment_i), robot(loop.segment_j))];
  PairsOfRobots pairs;
  for (const auto& [robots, count] : held)
    if (count >= kMinContradicting) pairs.insert(robots);
  return pairs;
}

template <class Pose>
class ClosureJudge {
 public:
  ClosureJudge(JointGraph<Pose> joint, TeamAlignment<Pose>& alignment, const std::vector<Closure>& closures,
               const ClosureEvidence<Pose>& evidence, const OptimizerParams& optimizer,
               const Progress& progress)
      : alignment_(alignment),
        closures_(closures),
        evidence_(evidence),
        optimizer_(optimizer),
        progress_(progress),
        frames_(frames_of(alignment)),
        of_radio_(alignment.alternatives),
        weight_before_(alignment.weight) {
    team_.loops = team_loops(joint, closures, evidence.admissions);
    team_.joint = std::move(joint);
  }

  std::optional<LoopChoiceResult> run(std::vector<ClosureJudgement>& judgements) {
    if (team_.loops.empty()) return std::nullopt;
    take_out(team_.joint, team_.loops);
    for (int pass = 0; pass < kMaxPasses; ++pass)
      if (align_and_select(pass)) break;
    if (component_ != alignment_.of_segment) join_components(team_.joint, component_, alignment_);
    solve();
    describe(judgements);
    note_scales(team_.selection, alignment_);
    return std::move(choice_);
  }

  JointGraph<Pose> joint() && { return std::move(team_.joint); }

 private:
  /// Joins frames by groups of loops, and selects loops there. Returns whether it was the last pass.
  bool align_and_select(int pass) {
    auto& [joint, loops, selection, likelihood] = team_;
    const double odometry_scale = std::max(selection.odometry_scale, std::pow(2.0, pass)),
                 loop_scale = selection.loop_scale;
    const auto chains = segment_chains(joint, loops, odometry_scale);
    frames_.groups =
        held_against_maps(evidence_.maps, closures_, loops,
                          loop_groups(joint, loops, chains, {.consistency = evidence_.consistency}));
    auto alignments =
        align_by_loops(joint, frames_.component, loops, frames_.groups, chains, evidence_.radio);
    if (!has_unit_weights(evidence_.consistency))
      undo_weak_joins(frames_.groups, joint.robot_of_segment, alignments);
    LoopAlignment& best = alignments.front();
    const JointGraph<Pose> before = joint;
    const std::vector<TeamLoop<Pose>> loops_before = loops;
    accept_groups(frames_.groups, best, loops);
    joint.team.graph.poses = frames_.moved(joint, joint.team.graph.poses, loops, best);
    selection = select_loops(joint, best.component, loops, optimizer_, progress_);
    if (of_radio_.empty()) {
      set_alternatives(before, loops_before, loops, frames_, alignments, optimizer_, alignment_);
      alignment_.weight *= weight_before_;
    } else {
      alignment_.weight = weight_before_;
      alignment_.alternative_weights.resize(of_radio_.size());
      alignment_.alternatives.clear();
      for (const std::vector<Pose>& poses : of_radio_)
        alignment_.alternatives.push_back(frames_.moved(joint, poses, loops, best));
    }
    append_valleys(selection, alignment_);
    choice_ = described(joint, loops, selection);
    for (TeamLoop<Pose>& loop : loops) loop.covariance *= selection.loop_scale * selection.loop_scale;
    selection.loop_scale *= loop_scale;
    const bool is_open = std::any_of(loops.begin(), loops.end(), [&](const TeamLoop<Pose>& loop) {
      return best.component[loop.segment_i] != best.component[loop.segment_j];
    });
    if (is_open && pass + 1 < kMaxPasses) return false;
    component_ = best.component = joined_by_accepted(alignment_.of_segment, loops);
    const std::string measured = closures_.front().kind == ClosureKind::kMatch ? "matches" : "loop closures";
    note_groups(joint, loops, frames_.groups, best, measured, alignment_);
    return true;
  }

  /// With the links of robots that loops determine, too, and without these until both are weighed again.
  void solve() {
    const PairsOfRobots pairs = evidence_.links ? pairs_with_loops(team_) : PairsOfRobots{};
    LoopSolution<Pose> without_links = team_;
    finish(team_);
    if (pairs.empty()) return;
    silence_links(without_links.joint, pairs);
    const double loop_scale = without_links.selection.loop_scale;
    without_links.selection =
        select_loops(without_links.joint, component_, without_links.loops, optimizer_, progress_);
    without_links.selection.loop_scale *= loop_scale;
    finish(without_links);
    if (without_links.log_likelihood > team_.log_likelihood) team_ = std::move(without_links);
  }

  /// Adds the loops that hold, and solves; links and loops are then weighed by the solution.
  void finish(LoopSolution<Pose>& team) const {
    JointGraph<Pose>& joint = team.joint;
    const double scale = team.selection.odometry_scale;
    if (!evidence_.links || is_notable(scale)) scale_odometry(joint, scale);
    const std::size_t first = joint.team.graph.relative_poses.size();
    add_accepted(joint, team.loops, closures_);
    optimize(joint.team.graph, optimizer_, progress_);
    if (!evidence_.links) return;
    for (int round = 0; round < kReweighings; ++round) {
      team.log_likelihood = reweigh_radio_links(joint, alignment_, *evidence_.links);
      test_again(team, first);
      optimize(joint.team.graph, optimizer_, progress_);
    }
    std::size_t k = first;
    for (TeamLoop<Pose>& loop : team.loops) {
      if (loop.accepted) loop.accepted = joint.team.graph.relative_poses[k++].weight > 0;
      if (!loop.accepted && loop.admission == Admission::kAdmitted) team.log_likelihood -= loop.gate / 2;
    }
  }

  /// Gives loops no weight that do not fit the solution. `first`: factor of the first one accepted.
  void test_again(LoopSolution<Pose>& team, std::size_t first) const {
    const double variance = team.selection.loop_scale * team.selection.loop_scale;
    PoseGraph<Pose>& graph = team.joint.team.graph;
    for (TeamLoop<Pose>& loop : team.loops) {
      if (!loop.accepted) continue;
      RelativePoseFactor<Pose>& factor = graph.relative_poses[first++];
      factor.weight = 1;
      loop.statistic = variance * squared_norm(graph, factor);
      factor.weight = loop.statistic <= std::max(loop.gate, kPoseChiSquared999<Pose> * variance) ? 1 : 0;
    }
  }

  void describe(std::vector<ClosureJudgement>& judgements) const {
    for (const TeamLoop<Pose>& loop : team_.loops)
      for (const std::size_t k : loop.closures) {
        judgements[k].statistic = loop.statistic;
        if (loop.accepted) continue;
        const bool open = component_[loop.segment_i] != component_[loop.segment_j];
        const bool is_admitted = loop.admission == Admission::kAdmitted;
        reject(judgements[k], !is_admitted ? evidence_.admissions[k].reason
                              : open       ? "no group of loops stands out"
                                           : "the joint estimate disagrees");
      }
  }

  TeamAlignment<Pose>& alignment_;
  const std::vector<Closure>& closures_;
  const ClosureEvidence<Pose>& evidence_;
  const OptimizerParams& optimizer_;
  const Progress& progress_;
  Frames<Pose> frames_;
  const std::vector<std::vector<Pose>> of_radio_;  ///< alternatives before loops joined any frames
  const double weight_before_;                     ///< of the frames that loops join
  LoopSolution<Pose> team_;
  std::vector<int> component_;  ///< per segment
  LoopChoiceResult choice_;
};

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
                                               const ClosureEvidence<Pose>& evidence,
                                               const OptimizerParams& optimizer, const Progress& progress) {
  for (std::size_t k = 0; k < closures.size(); ++k)
    if (!closure_ends(joint, closures[k]).valid()) reject(judgements[k], "no odometry at its time");
  ClosureJudge<Pose> judge(std::move(joint), alignment, closures, evidence, optimizer, progress);
  auto choice = judge.run(judgements);
  joint = std::move(judge).joint();
  return choice;
}

template <class Pose>
void close_by_all(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                  const std::vector<ClosureAdmission>& admissions, std::vector<ClosureJudgement>& judgements,
                  const OptimizerParams& optimizer, const Progress& progress) {
  erase_relative_poses(joint, [](const FactorOrigin& o) { return o.source == FactorSource::kLoop; });
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (!closure_ends(joint, closures[k]).valid()) {
      reject(judgements[k], "no odometry at its time");
    } else if (admissions[k].admission != Admission::kAdmitted) {
      reject(judgements[k], admissions[k].reason);
    } else {
      RelativePoseFactor<Pose> factor = closure_factor(joint, closures[k]);
      factor.information *= admissions[k].information_scale;
      add_closure(joint, closures[k], std::move(factor), FactorSource::kLoop, k);
    }
  }
  optimize(joint.team.graph, optimizer, progress);
  for (const std::size_t k : factors_of(joint.origins.relative_poses, FactorSource::kLoop))
    judgements[joint.origins.relative_poses[k].measurement].statistic =
        squared_norm(joint.team.graph, joint.team.graph.relative_poses[k]);
}

#define RADIOSLAM_LOOP_STAGE(Pose)                                                                          \
  template void add_own_loops(JointGraph<Pose>&, const std::vector<Closure>&, const OptimizerParams&);      \
  template std::optional<LoopChoiceResult> close_by_loops(                                                  \
      JointGraph<Pose>&, TeamAlignment<Pose>&, const std::vector<Closure>&, std::vector<ClosureJudgement>&, \
      const ClosureEvidence<Pose>&, const OptimizerParams&, const Progress&);                               \
  template void close_by_all(JointGraph<Pose>&, const std::vector<Closure>&,                                \
                             const std::vector<ClosureAdmission>&, std::vector<ClosureJudgement>&,          \
                             const OptimizerParams&, const Progress&);
RADIOSLAM_LOOP_STAGE(SE2)
RADIOSLAM_LOOP_STAGE(SE3)
#undef RADIOSLAM_LOOP_STAGE

}  // namespace radioslam

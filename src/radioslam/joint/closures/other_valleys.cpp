#include "radioslam/joint/closures/other_valleys.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/agreeing_loops.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxTrials = 24;
constexpr double kNoise = 2;  // quantiles that a group which is right may add to the rest
constexpr int kMaxSettling = 6;
constexpr GraduatedParams kTrial{.mu_factor = 10, .steps_per_round = 2};
constexpr double kTolerance = 1e-5;  // of the cost, to which trials are solved
constexpr double kHopeless =
    1.3;  // of the best cost: what a trial may cost before its loops are judged again
constexpr double kMinGain = 1e-3;  // of the truncated cost
/// Cost of an alternative above the best: e^-7 of its likelihood where errors are twice as large as stated.
constexpr double kMaxExcess = 56;
constexpr double kElsewhere_m = 0.5;  // that an alternative moves what a group ties

using Group = std::vector<std::size_t>;  // of loops

/// What the loops of a group cost in this solution.
template <class Pose>
double price(const LoopChoice<Pose>& choice, const Group& group) {
  double sum = 0;
  for (const std::size_t k : group)
    sum += std::min(choice.gates[k], squared_norm(choice.graph, choice.loop(k)));
  return sum;
}

template <class Pose>
bool is_held(const LoopChoice<Pose>& choice, const Group& group) {
  const auto held =
      std::count_if(group.begin(), group.end(), [&](std::size_t k) { return choice.accepted[k]; });
  return 2 * static_cast<std::size_t>(held) > group.size();
}

/// Starts of the trials of a group: as it is, or with one of two trajectories moved to where the group puts
/// it.
template <class Pose>
std::vector<LoopChoice<Pose>> trials_of(const LoopChoice<Pose>& choice, const Group& group, Fate fate) {
  const auto& loop = choice.loop(group[group.size() / 2]);
  const std::size_t a = choice.segment_of[loop.i.index()], b = choice.segment_of[loop.j.index()];
  if (a == b || fate == Fate::kIsDropped) return {choice};
  std::vector<LoopChoice<Pose>> trials{choice, choice};
  const auto place = [&](LoopChoice<Pose>& trial, std::size_t segment, const Pose& own_shape,
                         const Pose& there) {
    const Pose move = there * own_shape.inverse();
    for (std::size_t k = 0; k < choice.own_shape.size(); ++k)
      if (choice.segment_of[k] == segment) trial.graph.poses[k] = move * choice.own_shape[k];
  };
  place(trials[0], b, choice.own_shape[loop.j.index()], choice.graph.poses[loop.i.index()] * loop.T_i_j);
  place(trials[1], a, choice.own_shape[loop.i.index()],
        choice.graph.poses[loop.j.index()] * loop.T_i_j.inverse());
  return trials;
}

template <class Pose>
class ValleySearch {
 public:
  ValleySearch(LoopChoice<Pose>& choice, const OptimizerParams& optimizer)
      : best_(choice),
        loops_(choice),
        groups_(loops_.groups()),
        equations_(choice.graph),
        solver_(optimizer) {
    std::erase_if(groups_, [](const Group& group) { return group.size() < 2; });
    solver_.relative_cost_tolerance = std::max(optimizer.relative_cost_tolerance, kTolerance);
    cost_ = truncated_cost(best_);
    is_calm_.resize(groups_.size());
  }

  Valleys<Pose> run() {
    while (try_groups()) {
    }
    return {std::move(trials_), others()};
  }

 private:
  /// Tries groups, those with most at stake first, until one leads to a better solution.
  bool try_groups() {
    for (const auto& [at_stake, g] : worth_a_trial()) {
      const Fate fate = is_held(best_, groups_[g]) ? Fate::kIsDropped : Fate::kHolds;
      for (LoopChoice<Pose>& other : trials_of(best_, groups_[g], fate)) {
        if (trials_.size() >= kMaxTrials) return false;
        choose_gradually(other, groups_[g], fate, kTrial, solver_);
        if (truncated_cost(other) < kHopeless * cost_) settle(other);
        double cost = truncated_cost(other);
        const bool is_better = cost < cost_ * (1 - kMinGain);
        trials_.push_back({groups_[g], fate, cost, is_better});
        if (is_better) std::swap(best_, other), std::swap(cost_, cost);
        keep(other, cost, g);
        if (is_better) return true;
      }
    }
    return false;
  }

  void keep(const LoopChoice<Pose>& other, double cost, std::size_t group) {
    if (cost <= cost_ + kMaxExcess)
      kept_.push_back({cost, other.accepted, other.graph.poses}), of_.push_back(group);
  }

  bool is_elsewhere(const OtherValley<Pose>& other, const Group& group) const {
    const auto& loop = best_.loop(group[group.size() / 2]);
    const auto motion = [&](const std::vector<Pose>& poses) {
      return poses[loop.i.index()].inverse() * poses[loop.j.index()];
    };
    return (motion(other.poses).translation() - motion(best_.graph.poses).translation()).norm() >
           kElsewhere_m;
  }

  /// Of what was kept, solutions that are still near the best, each choice of loops once.
  std::vector<OtherValley<Pose>> others() {
    std::vector<OtherValley<Pose>> result;
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      OtherValley<Pose>& other = kept_[k];
      const bool is_known = std::any_of(result.begin(), result.end(),
                                        [&](const auto& o) { return o.accepted == other.accepted; });
      if (!is_known && other.cost <= cost_ + kMaxExcess && is_elsewhere(other, groups_[of_[k]]))
        result.push_back(std::move(other));
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
    return result;
  }

  /// Judges all loops by the solution, and solves, until nothing changes.
  void settle(LoopChoice<Pose>& choice) {
    for (int round = 0; round < kMaxSettling; ++round) {
      set_weights(choice);
      optimize(choice.graph, equations_, solver_);
      std::vector<bool> holds(choice.gates.size());
      for (std::size_t k = 0; k < holds.size(); ++k)
        holds[k] = squared_norm(choice.graph, choice.loop(k)) <= choice.gates[k];
      if (holds == choice.accepted) return;
      choice.accepted = std::move(holds);
    }
    set_weights(choice);
    optimize(choice.graph, equations_, solver_);
  }

  /// Groups with what is at stake in a trial of them: what it costs where a group is rejected, its strain
  /// where it holds. A rejected group is not worth one where a group that holds contradicts it along the
  /// odometry, and bending that or giving up the other costs more than there is to gain.
  std::vector<std::pair<double, std::size_t>> worth_a_trial() {
    std::vector<std::pair<double, std::size_t>> worth, held;
    double all_strain = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!is_held(best_, groups_[g])) {
        is_calm_[g] = false;
        continue;
      }
      double gates = 0;
      for (const std::size_t k : groups_[g]) gates += best_.gates[k];
      held.push_back({gates - price(best_, groups_[g]), g});
      const double of_group = is_calm_[g] ? 0 : strain(groups_[g]);
      is_calm_[g] = of_group == 0;
      if (of_group > 0) worth.push_back({of_group, g});
      all_strain += of_group;
    }
    const auto largest_first = [](const auto& a, const auto& b) {
      return a.first > b.first || (a.first == b.first && a.second < b.second);
    };
    std::sort(held.begin(), held.end(), largest_first);
    const auto middle = [&](std::size_t g) { return groups_[g][groups_[g].size() / 2]; };
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (is_held(best_, groups_[g])) continue;
      const double its_price = price(best_, groups_[g]), gain = its_price + all_strain;
      const bool is_hopeless = std::any_of(held.begin(), held.end(), [&](const auto& other) {
        return other.first > gain && loops_.disagreement(middle(g), middle(other.second)).value_or(0) > gain;
      });
      if (!is_hopeless) worth.push_back({its_price, g});
    }
    std::sort(worth.begin(), worth.end(), largest_first);
    return worth;
  }

  /// What the rest of the graph pays for a group that holds, beyond noise: the decrease of its cost that the
  /// first step without the group promises.
  double strain(const Group& group) {
    for (const std::size_t k : group) best_.loop(k).weight = 0;
    equations_.linearise(best_.graph);
    // What hangs on the group alone is free without it.
    double decrease = 0;
    if (equations_.factorize(solver_.negligible_damping) != Factorization::kNotPositiveDefinite)
      decrease = equations_.predicted_decrease(equations_.step());
    for (const std::size_t k : group) best_.loop(k).weight = best_.accepted[k] ? 1 : 0;
    return std::max(
        0.0, decrease - kNoise * (kPoseChiSquared999<Pose> + Pose::kDof * static_cast<double>(group.size())));
  }

  LoopChoice<Pose>& best_;
  AgreeingLoops<Pose> loops_;
  std::vector<Group> groups_;
  std::vector<bool> is_calm_;  ///< per group: it has held without strain since it was measured
  NormalEquations<Pose> equations_;
  OptimizerParams solver_;
  double cost_ = 0;
  std::vector<ValleyTrial> trials_;
  std::vector<OtherValley<Pose>> kept_;
  std::vector<std::size_t> of_;  ///< per kept solution: the group that led to or from it
};

}  // namespace

template <class Pose>
Valleys<Pose> leave_valleys(LoopChoice<Pose>& choice, const OptimizerParams& optimizer) {
  return ValleySearch<Pose>(choice, optimizer).run();
}

template Valleys<SE2> leave_valleys(LoopChoice<SE2>&, const OptimizerParams&);
template Valleys<SE3> leave_valleys(LoopChoice<SE3>&, const OptimizerParams&);

}  // namespace radioslam

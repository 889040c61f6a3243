#include "radioslam/joint/closures/other_valleys.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 40;  // poses between loops that are compared
constexpr double kOdometryVariance = 4;  // over the stated one: it is often understated
constexpr std::size_t kMaxTrials = 24;
constexpr double kNoise = 2;  // quantiles that a group which is right may add to the rest
constexpr int kMaxSettling = 6;
constexpr GraduatedParams kTrial{.mu_factor = 3, .steps_per_round = 3};
constexpr double kHopeless =
    1.3;  // of the best cost: what a trial may cost before its loops are judged again
constexpr double kMinGain = 1e-3;  // of the truncated cost

using Group = std::vector<std::size_t>;  // of loops

/// Groups of loops that agree with one another along the odometry at both ends.
template <class Pose>
class AgreeingLoops {
 public:
  explicit AgreeingLoops(const LoopChoice<Pose>& choice) : choice_(choice), step_(choice.graph.poses.size()) {
    for (std::size_t k = 0; k < choice_.first_loop(); ++k) {
      const auto& factor = choice_.graph.relative_poses[k];
      if (choice_.is_odometry[k] && factor.j.index() == factor.i.index() + 1)
        step_[factor.j.index()] = &factor;
    }
  }

  std::vector<Group> groups() {
    const std::size_t loops = choice_.gates.size();
    std::vector<std::size_t> by_start(loops);
    std::iota(by_start.begin(), by_start.end(), std::size_t{0});
    std::stable_sort(by_start.begin(), by_start.end(),
                     [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
    parent_.resize(loops);
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t a = 0; a < loops; ++a)
      for (std::size_t b = a + 1; b < loops && low(by_start[b]) - low(by_start[a]) <= kNeighbours; ++b)
        if (root(by_start[a]) != root(by_start[b]) && agree(by_start[a], by_start[b]))
          parent_[root(by_start[b])] = root(by_start[a]);
    std::map<std::size_t, Group> of_root;
    for (std::size_t k = 0; k < loops; ++k)
      if (choice_.may_hold[k]) of_root[root(k)].push_back(k);
    std::vector<Group> groups;
    for (auto& [root, group] : of_root) groups.push_back(std::move(group));
    return groups;
  }

  /// Squared norm of what the way round two loops and the odometry between their ends fails to close by.
  std::optional<double> disagreement(std::size_t a, std::size_t b) const {
    const auto at_low = way(low(a), low(b)), at_high = way(high(a), high(b));
    if (!at_low || !at_high) return std::nullopt;
    const UncertainPose<Pose> one = measured(a) * *at_high, other = *at_low * measured(b);
    const typename Pose::Jacobian covariance = one.covariance + other.covariance;
    const Cholesky<typename Pose::Jacobian> cholesky(covariance);
    if (!cholesky.succeeded()) return std::nullopt;
    return cholesky.whitened((one.pose.inverse() * other.pose).log()).squaredNorm();
  }

 private:
  const RelativePoseFactor<Pose>& factor(std::size_t loop) const {
    return choice_.graph.relative_poses[choice_.first_loop() + loop];
  }
  std::size_t low(std::size_t loop) const { return std::min(factor(loop).i, factor(loop).j).index(); }
  std::size_t high(std::size_t loop) const { return std::max(factor(loop).i, factor(loop).j).index(); }

  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }

  /// The loop from its lower pose to its higher one.
  UncertainPose<Pose> measured(std::size_t loop) const {
    const auto& f = factor(loop);
    const UncertainPose<Pose> pose{f.T_i_j, inverse(f.information)};
    return f.i < f.j ? pose : pose.inverse();
  }

  /// The odometry from pose `i` to pose `j`; nothing across a gap.
  std::optional<UncertainPose<Pose>> way(std::size_t i, std::size_t j) const {
    UncertainPose<Pose> sum{Pose(), Pose::Jacobian::Zero()};
    for (std::size_t k = std::min(i, j) + 1; k <= std::max(i, j); ++k) {
      if (!step_[k]) return std::nullopt;
      const typename Pose::Jacobian covariance = kOdometryVariance * inverse(step_[k]->information);
      sum = sum * UncertainPose<Pose>{step_[k]->T_i_j, covariance};
    }
    return i <= j ? sum : sum.inverse();
  }

  bool agree(std::size_t a, std::size_t b) const {
    const std::size_t apart = high(a) > high(b) ? high(a) - high(b) : high(b) - high(a);
    if (apart > kNeighbours || !choice_.may_hold[a] || !choice_.may_hold[b]) return false;
    const auto statistic = disagreement(a, b);
    return statistic && *statistic <= kPoseChiSquared999<Pose>;
  }

  const LoopChoice<Pose> choice_;                      // a copy: solutions come and go
  std::vector<const RelativePoseFactor<Pose>*> step_;  ///< to each pose from the one before it, or null
  std::vector<std::size_t> parent_;
};

template <class Pose>
void set_weights(LoopChoice<Pose>& choice) {
  for (std::size_t k = 0; k < choice.gates.size(); ++k)
    choice.graph.relative_poses[choice.first_loop() + k].weight = choice.accepted[k] ? 1 : 0;
}

/// Judges all loops by the solution, and solves, until nothing changes.
template <class Pose>
void settle(LoopChoice<Pose>& choice, const OptimizerParams& optimizer) {
  for (int round = 0; round < kMaxSettling; ++round) {
    set_weights(choice);
    optimize(choice.graph, optimizer);
    std::vector<bool> holds = choice.may_hold;
    for (std::size_t k = 0; k < holds.size(); ++k)
      holds[k] =
          holds[k] &&
          squared_norm(choice.graph, choice.graph.relative_poses[choice.first_loop() + k]) <= choice.gates[k];
    if (holds == choice.accepted) return;
    choice.accepted = std::move(holds);
  }
  set_weights(choice);
  optimize(choice.graph, optimizer);
}

enum class Fate { kHolds, kIsDropped };

/// The solution in which a group holds from the start, or has gone, and all others are chosen anew.
template <class Pose>
void choose_around(const Group& group, Fate fate, double best, LoopChoice<Pose>& choice,
                   const OptimizerParams& optimizer) {
  FactorMask mask;
  mask.relative_poses.assign(choice.graph.relative_poses.size(), false);
  for (std::size_t k = 0; k < choice.gates.size(); ++k) {
    RelativePoseFactor<Pose>& factor = choice.graph.relative_poses[choice.first_loop() + k];
    factor.weight = choice.may_hold[k] ? 1 : 0;
    factor.loss = {LossKind::kNone, std::sqrt(choice.gates[k])};
    mask.relative_poses[choice.first_loop() + k] = choice.may_hold[k];
  }
  for (const std::size_t k : group) {
    mask.relative_poses[choice.first_loop() + k] = false;
    choice.graph.relative_poses[choice.first_loop() + k].weight = fate == Fate::kHolds ? 1 : 0;
  }
  const auto weights =
      optimize_graduated(choice.graph, mask, GraduatedLoss::kTruncatedLeastSquares, kTrial, optimizer)
          .weights.relative_poses;
  for (std::size_t k = 0; k < choice.gates.size(); ++k)
    choice.accepted[k] = choice.may_hold[k] && weights[choice.first_loop() + k] > 0.5;
  for (const std::size_t k : group) choice.accepted[k] = fate == Fate::kHolds;
  set_weights(choice);
  if (truncated_cost(choice) < kHopeless * best) settle(choice, optimizer);
}

/// What the loops of a group cost in this solution.
template <class Pose>
double price(const LoopChoice<Pose>& choice, const Group& group) {
  double sum = 0;
  for (const std::size_t k : group)
    sum += std::min(choice.gates[k],
                    squared_norm(choice.graph, choice.graph.relative_poses[choice.first_loop() + k]));
  return sum;
}

template <class Pose>
bool is_held(const LoopChoice<Pose>& choice, const Group& group) {
  const auto held =
      std::count_if(group.begin(), group.end(), [&](std::size_t k) { return choice.accepted[k]; });
  return 2 * static_cast<std::size_t>(held) > group.size();
}

/// What the rest of the graph pays for a group that holds, beyond noise.
template <class Pose>
double strain(const LoopChoice<Pose>& choice, const Group& group, const OptimizerParams& optimizer) {
  LoopChoice<Pose> without = choice;
  for (const std::size_t k : group) without.accepted[k] = false;
  set_weights(without);
  const double before = total_cost(without.graph);
  optimize(without.graph, optimizer);
  return std::max(0.0,
                  before - total_cost(without.graph) -
                      kNoise * (kPoseChiSquared999<Pose> + Pose::kDof * static_cast<double>(group.size())));
}

/// Groups with what is at stake in a trial of them: what it costs where a group is rejected, its strain where
/// it holds. A rejected group is not worth one where a group that holds contradicts it along the odometry,
/// and bending that or giving up the other costs more than there is to gain.
template <class Pose>
std::vector<std::pair<double, std::size_t>> worth_a_trial(const LoopChoice<Pose>& choice,
                                                          const std::vector<Group>& groups,
                                                          const AgreeingLoops<Pose>& loops,
                                                          const OptimizerParams& optimizer) {
  std::vector<std::pair<double, std::size_t>> worth, held;
  double all_strain = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_held(choice, groups[g])) continue;
    double gates = 0;
    for (const std::size_t k : groups[g]) gates += choice.gates[k];
    held.push_back({gates - price(choice, groups[g]), g});
    const double of_group = strain(choice, groups[g], optimizer);
    if (of_group > 0) worth.push_back({of_group, g});
    all_strain += of_group;
  }
  const auto largest_first = [](const auto& a, const auto& b) {
    return a.first > b.first || (a.first == b.first && a.second < b.second);
  };
  std::sort(held.begin(), held.end(), largest_first);
  const auto middle = [&](std::size_t g) { return groups[g][groups[g].size() / 2]; };
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (is_held(choice, groups[g])) continue;
    const double its_price = price(choice, groups[g]), gain = its_price + all_strain;
    const bool is_hopeless = std::any_of(held.begin(), held.end(), [&](const auto& other) {
      return other.first > gain && loops.disagreement(middle(g), middle(other.second)).value_or(0) > gain;
    });
    if (!is_hopeless) worth.push_back({its_price, g});
  }
  std::sort(worth.begin(), worth.end(), largest_first);
  return worth;
}

template <class Pose>
Fate fate_of(const LoopChoice<Pose>& choice, const Group& group) {
  return is_held(choice, group) ? Fate::kIsDropped : Fate::kHolds;
}

/// Starts of the trials of a group: as it is, or with one of two trajectories moved to where the group puts
/// it.
template <class Pose>
std::vector<LoopChoice<Pose>> trials_of(const LoopChoice<Pose>& choice, const Group& group) {
  const auto& loop = choice.graph.relative_poses[choice.first_loop() + group[group.size() / 2]];
  const std::size_t a = choice.segment_of[loop.i.index()], b = choice.segment_of[loop.j.index()];
  if (a == b || is_held(choice, group)) return {choice};
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

}  // namespace

template <class Pose>
double truncated_cost(const LoopChoice<Pose>& choice) {
  double cost = total_cost(choice.graph);
  for (std::size_t k = 0; k < choice.gates.size(); ++k) {
    if (!choice.may_hold[k]) continue;
    const RelativePoseFactor<Pose>& factor = choice.graph.relative_poses[choice.first_loop() + k];
    const double norm = squared_norm(choice.graph, factor);
    cost += std::min(choice.gates[k], norm) - factor.weight * norm;
  }
  return cost;
}

template <class Pose>
void leave_valleys(LoopChoice<Pose>& choice, const OptimizerParams& optimizer) {
  double best = truncated_cost(choice);
  std::size_t tried = 0;
  AgreeingLoops<Pose> loops(choice);
  std::vector<Group> groups = loops.groups();
  std::erase_if(groups, [](const Group& group) { return group.size() < 2; });
  while (tried < kMaxTrials) {
    const auto order = worth_a_trial(choice, groups, loops, optimizer);
    bool moved = false;
    for (std::size_t k = 0; k < order.size() && !moved; ++k)
      for (LoopChoice<Pose>& other : trials_of(choice, groups[order[k].second])) {
        if (tried >= kMaxTrials) break;
        choose_around(groups[order[k].second], fate_of(choice, groups[order[k].second]), best, other,
                      optimizer);
        ++tried;
        const double cost = truncated_cost(other);
        if (!(cost < best * (1 - kMinGain))) continue;
        choice = std::move(other);
        best = cost;
        moved = true;
        break;
      }
    if (!moved) break;
  }
}

#define RADIOSLAM_OTHER_VALLEYS(Pose)                      \
  template double truncated_cost(const LoopChoice<Pose>&); \
  template void leave_valleys(LoopChoice<Pose>&, const OptimizerParams&);
RADIOSLAM_OTHER_VALLEYS(SE2)
RADIOSLAM_OTHER_VALLEYS(SE3)
#undef RADIOSLAM_OTHER_VALLEYS

}  // namespace radioslam

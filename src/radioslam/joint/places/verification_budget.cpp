#include "radioslam/joint/places/verification_budget.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

using Indices = std::vector<std::size_t>;

void sort_by_similarity(const std::vector<Proposal>& proposals, Indices& of) {
  std::stable_sort(of.begin(), of.end(), [&](std::size_t x, std::size_t y) {
    return proposals[x].descriptor_distance < proposals[y].descriptor_distance;
  });
}

/// The most similar of every pair of robots in turn.
Indices in_turn(const std::vector<Proposal>& proposals, Indices similar) {
  sort_by_similarity(proposals, similar);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> turns;
  std::vector<std::pair<std::size_t, std::size_t>> by_turn;
  for (const std::size_t k : similar) by_turn.emplace_back(turns[{proposals[k].a, proposals[k].b}]++, k);
  std::stable_sort(by_turn.begin(), by_turn.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  Indices result;
  for (const auto& [turn, k] : by_turn) result.push_back(k);
  return result;
}

Indices alternating(const Indices& x, const Indices& y) {
  Indices result;
  for (std::size_t n = 0; n < std::max(x.size(), y.size()); ++n) {
    if (n < x.size()) result.push_back(x[n]);
    if (n < y.size()) result.push_back(y[n]);
  }
  return result;
}

Indices shuffled(Indices of) {
  Rng rng(of.size());
  for (std::size_t n = of.size(); n > 1; --n) std::swap(of[n - 1], of[rng.below(n)]);
  return of;
}

WeighedPair weighed(const Proposal& pair, const ScannedRobot& a, const ScannedRobot& b,
                    const ScanLoopParams& loops) {
  const double radius_m = loops.radius_ratio * b.cloud(pair.j).median_range_m();
  const double near = probability_within(radius_m, pair.T_i_j.pose.translation().head<2>(),
                                         pair.T_i_j.position_covariance().topLeftCorner<2, 2>());
  return {a.nodes[pair.i], b.nodes[pair.j], near * (1 - pair.descriptor_distance), pair.alignment,
          pair.alignment_weight};
}

template <class Pose>
Indices by_worth(const std::vector<Proposal>& proposals, const Indices& of,
                 const std::vector<ScannedRobot>& robots, const PredictedPoses<Pose>& predicted,
                 const ScanLoopParams& loops, const VerificationBudget& budget) {
  std::vector<WeighedPair> pairs;
  for (const std::size_t k : of)
    pairs.push_back(weighed(proposals[k], robots[proposals[k].a], robots[proposals[k].b], loops));
  const SE3::Jacobian cov_closure =
      isotropic(loops.min_sigma_m * loops.min_sigma_m, loops.min_sigma_rad * loops.min_sigma_rad);
  Indices result;
  for (const std::size_t n : choose_by_worth(pairs, predicted, covariance_as<Pose>(cov_closure),
                                             budget.registrations, budget.least_worth))
    result.push_back(of[n]);
  return result;
}

}  // namespace

template <class Pose>
Indices within_budget(const VerificationBudget& budget, const std::vector<Proposal>& proposals,
                      const std::vector<ScannedRobot>& robots, const PredictedPoses<Pose>* predicted,
                      const ScanLoopParams& loops) {
  Indices anywhere, near;
  for (std::size_t k = 0; k < proposals.size(); ++k) (proposals[k].anywhere ? anywhere : near).push_back(k);
  switch (budget.order) {
    case VerificationBudget::Order::kWorth:
      anywhere = in_turn(proposals, std::move(anywhere));
      if (predicted) near = by_worth(proposals, near, robots, *predicted, loops, budget);
      break;
    case VerificationBudget::Order::kSimilarity:
      anywhere = in_turn(proposals, std::move(anywhere));
      sort_by_similarity(proposals, near);
      break;
    case VerificationBudget::Order::kRandom:
      anywhere = shuffled(std::move(anywhere));
      near = shuffled(std::move(near));
      break;
  }
  Indices chosen = alternating(anywhere, near);
  if (!budget.takes_all_anywhere) chosen.resize(std::min(chosen.size(), budget.registrations));
  return chosen;
}

#define RADIOSLAM_BUDGET(Pose)                                                                  \
  template Indices within_budget(const VerificationBudget&, const std::vector<Proposal>&,       \
                                 const std::vector<ScannedRobot>&, const PredictedPoses<Pose>*, \
                                 const ScanLoopParams&);
RADIOSLAM_BUDGET(SE2)
RADIOSLAM_BUDGET(SE3)
#undef RADIOSLAM_BUDGET

}  // namespace radioslam

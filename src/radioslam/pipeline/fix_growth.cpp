#include "radioslam/pipeline/fix_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr double kNowhere_m = std::numeric_limits<double>::infinity();

/// The way from every fix to the nearest other one that holds, or to a seed while none does.
template <class Pose>
std::vector<double> ways_to_set(const GrowingFixes<Pose>& fixes) {
  const auto& of_way = fixes.of_way;
  std::vector<double> way_m(of_way.size(), kNowhere_m);
  if (std::none_of(fixes.holds.begin(), fixes.holds.end(), [](bool holds) { return holds; })) {
    for (std::size_t k = 0; k < of_way.size(); ++k)
      for (const double seed_m : fixes.seeds_m)
        way_m[k] = std::min(way_m[k], std::abs(of_way[k].way_m - seed_m));
    return way_m;
  }
  double before_m = -kNowhere_m, after_m = kNowhere_m;
  for (std::size_t k = 0; k < of_way.size(); ++k) {
    way_m[k] = std::min(way_m[k], of_way[k].way_m - before_m);
    if (fixes.holds[k]) before_m = of_way[k].way_m;
  }
  for (std::size_t k = of_way.size(); k-- > 0;) {
    way_m[k] = std::min(way_m[k], after_m - of_way[k].way_m);
    if (fixes.holds[k]) after_m = of_way[k].way_m;
  }
  return way_m;
}

/// Judges a robot's fixes at the graph's values; sets the scales of their losses. Whether the set changed.
template <class Pose>
bool judge_fixes(const PoseGraph<Pose>& graph, GrowingFixes<Pose>& fixes, const FixGrowthParams& params) {
  const std::vector<double> way_m = ways_to_set(fixes);
  std::vector<bool> passes(way_m.size());
  double least_m = kNowhere_m;
  for (std::size_t k = 0; k < way_m.size(); ++k) {
    const double sigma_m = fixes.of_way[k].sigma_m, drift_m = params.drift_share * way_m[k];
    const double variance = sigma_m * sigma_m + drift_m * drift_m;
    const double residual2 = residual(graph, fixes.factors[k]).squaredNorm();
    passes[k] = residual2 <= params.gate * variance;
    if (passes[k] && !fixes.holds[k]) least_m = std::min(least_m, drift_m);
    fixes.factors[k].loss = {LossKind::kGemanMcClure,
                             std::sqrt(params.gate * variance * fixes.factors[k].information(0, 0))};
  }
  bool changed = false;
  for (std::size_t k = 0; k < way_m.size(); ++k) {
    const double near_m = std::max(fixes.of_way[k].sigma_m, params.reach * least_m);
    const bool holds = passes[k] && (fixes.holds[k] || params.drift_share * way_m[k] <= near_m);
    changed = changed || holds != fixes.holds[k];
    fixes.holds[k] = holds;
  }
  return changed;
}

}  // namespace

template <class Pose>
void grow_fixes(PoseGraph<Pose>& graph, std::vector<GrowingFixes<Pose>>& team, const FixGrowthParams& params,
                const OptimizerParams& optimizer) {
  for (auto& fixes : team) fixes.holds.assign(fixes.factors.size(), false);
  for (int round = 0; round < params.most_rounds; ++round) {
    bool changed = false;
    for (auto& fixes : team) changed = judge_fixes(graph, fixes, params) || changed;
    if (!changed) return;
    for (const auto& fixes : team)
      for (std::size_t k = 0; k < fixes.factors.size(); ++k)
        if (fixes.holds[k]) graph.positions.push_back(fixes.factors[k]);
    optimize(graph, optimizer);
    graph.positions.clear();
  }
}

template void grow_fixes(PoseGraph<SE2>&, std::vector<GrowingFixes<SE2>>&, const FixGrowthParams&,
                         const OptimizerParams&);
template void grow_fixes(PoseGraph<SE3>&, std::vector<GrowingFixes<SE3>>&, const FixGrowthParams&,
                         const OptimizerParams&);

}  // namespace radioslam

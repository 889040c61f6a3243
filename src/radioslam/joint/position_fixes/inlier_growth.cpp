#include "radioslam/joint/position_fixes/inlier_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr double kNowhere_m = std::numeric_limits<double>::infinity();

/// Path length from every fix to the nearest other inlier, or to a seed while there are no inliers.
template <class Pose>
std::vector<double> distances_to_inliers(const FixInliers<Pose>& fixes) {
  const auto& along_path = fixes.along_path;
  std::vector<double> path_m(along_path.size(), kNowhere_m);
  if (std::none_of(fixes.holds.begin(), fixes.holds.end(), [](bool holds) { return holds; })) {
    for (std::size_t k = 0; k < along_path.size(); ++k)
      for (const double seed_m : fixes.seeds_m)
        path_m[k] = std::min(path_m[k], std::abs(along_path[k].path_m - seed_m));
    return path_m;
  }
  double before_m = -kNowhere_m, after_m = kNowhere_m;
  for (std::size_t k = 0; k < along_path.size(); ++k) {
    path_m[k] = std::min(path_m[k], along_path[k].path_m - before_m);
    if (fixes.holds[k]) before_m = along_path[k].path_m;
  }
  for (std::size_t k = along_path.size(); k-- > 0;) {
    path_m[k] = std::min(path_m[k], after_m - along_path[k].path_m);
    if (fixes.holds[k]) after_m = along_path[k].path_m;
  }
  return path_m;
}

/// Classifies a robot's fixes at the graph's values and sets their loss scales. Returns whether the inliers
/// changed.
template <class Pose>
bool classify_fixes(const PoseGraph<Pose>& graph, FixInliers<Pose>& fixes, const FixGrowthParams& params) {
  const std::vector<double> path_m = distances_to_inliers(fixes);
  std::vector<bool> passes(path_m.size());
  double min_m = kNowhere_m;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const double sigma_m = fixes.along_path[k].sigma_m, drift_m = params.max_drift_ratio * path_m[k];
    const double variance = sigma_m * sigma_m + drift_m * drift_m;
    const double residual2 = residual(graph, fixes.factors[k]).squaredNorm();
    passes[k] = residual2 <= params.gate * variance;
    if (passes[k] && !fixes.holds[k]) min_m = std::min(min_m, drift_m);
    fixes.factors[k].loss = {LossKind::kGemanMcClure,
                             std::sqrt(params.gate * variance * fixes.factors[k].information(0, 0))};
  }
  bool changed = false;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const double near_m = std::max(fixes.along_path[k].sigma_m, params.reach * min_m);
    const bool holds = passes[k] && (fixes.holds[k] || params.max_drift_ratio * path_m[k] <= near_m);
    changed = changed || holds != fixes.holds[k];
    fixes.holds[k] = holds;
  }
  return changed;
}

}  // namespace

template <class Pose>
void grow_inliers(PoseGraph<Pose>& graph, std::vector<FixInliers<Pose>>& team, const FixGrowthParams& params,
                  const OptimizerParams& optimizer) {
  for (auto& fixes : team) fixes.holds.assign(fixes.factors.size(), false);
  for (int round = 0; round < params.max_rounds; ++round) {
    bool changed = false;
    for (auto& fixes : team) changed = classify_fixes(graph, fixes, params) || changed;
    if (!changed) return;
    for (const auto& fixes : team)
      for (std::size_t k = 0; k < fixes.factors.size(); ++k)
        if (fixes.holds[k]) graph.positions.push_back(fixes.factors[k]);
    optimize(graph, optimizer);
    graph.positions.clear();
  }
}

template void grow_inliers(PoseGraph<SE2>&, std::vector<FixInliers<SE2>>&, const FixGrowthParams&,
                           const OptimizerParams&);
template void grow_inliers(PoseGraph<SE3>&, std::vector<FixInliers<SE3>>&, const FixGrowthParams&,
                           const OptimizerParams&);

}  // namespace radioslam

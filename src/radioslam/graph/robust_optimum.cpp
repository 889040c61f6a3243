#include "radioslam/graph/robust_optimum.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/graph_values.hpp"

namespace radioslam {
namespace {

/// Candidates between the same two poses share their weight.
template <class Pose>
void share_weights(PoseGraph<Pose>& graph, const std::vector<bool>& candidates) {
  const auto ends = [](const RelativePoseFactor<Pose>& f) {
    return std::pair(std::min(f.i.value, f.j.value), std::max(f.i.value, f.j.value));
  };
  std::map<std::pair<std::int32_t, std::int32_t>, int> count;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (candidates[k]) ++count[ends(graph.relative_poses[k])];
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (candidates[k]) graph.relative_poses[k].weight /= count.at(ends(graph.relative_poses[k]));
}

/// The poses by the trusted relative poses alone.
template <class Pose>
std::vector<Pose> trusted_poses(const PoseGraph<Pose>& graph, const std::vector<bool>& candidates) {
  PoseGraph<Pose> trusted;
  trusted.poses = graph.poses;
  trusted.pose_fixed = graph.pose_fixed;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (!candidates[k]) trusted.relative_poses.push_back(graph.relative_poses[k]);
  initialise_from_spanning_tree(trusted);
  return trusted.poses;
}

template <class Pose>
InitialCosts choose_start(PoseGraph<Pose>& graph, const std::vector<bool>& candidates, GivenValues given) {
  std::vector<Pose> trusted = trusted_poses(graph, candidates);
  InitialCosts costs = initialise(graph, given);
  const double cost = total_cost(graph);
  std::swap(graph.poses, trusted);
  if (total_cost(graph) < cost)
    costs.chosen = InitialValues::kSpanningTree;
  else
    std::swap(graph.poses, trusted);
  return costs;
}

}  // namespace

template <class Pose>
RobustOptimum optimize_with_outliers(PoseGraph<Pose>& graph, const std::vector<bool>& candidates, double gate,
                                     GivenValues given, const OptimizerParams& params,
                                     const Progress& progress) {
  PoseGraph<Pose> work = graph;
  share_weights(work, candidates);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (candidates[k]) work.relative_poses[k].loss = {LossKind::kGemanMcClure, std::sqrt(gate)};
  RobustOptimum result;
  result.start = choose_start(work, candidates, given);
  const double start_cost = total_cost(work);
  FactorMask mask;
  mask.relative_poses = candidates;
  GraduatedSummary graduated =
      optimize_graduated(work, mask, GraduatedLoss::kTruncatedLeastSquares, {}, params, progress);
  result.summary = std::move(graduated.last);
  result.summary.iterations = graduated.iterations;
  result.summary.initial_cost = start_cost;
  result.weights = std::move(graduated.weights.relative_poses);
  GraphValues<Pose>(work).restore(graph);
  return result;
}

template <class Pose>
RobustOptimum optimize_with_weights(PoseGraph<Pose>& graph, const std::vector<bool>& candidates,
                                    std::vector<double> weights, const OptimizerParams& params,
                                    const Progress& progress) {
  PoseGraph<Pose> work = graph;
  share_weights(work, candidates);
  for (std::size_t k = 0; k < weights.size(); ++k) work.relative_poses[k].weight *= weights[k];
  RobustOptimum result;
  result.start.given = total_cost(work);
  result.summary = optimize(work, params, progress);
  result.weights = std::move(weights);
  GraphValues<Pose>(work).restore(graph);
  return result;
}

#define RADIOSLAM_ROBUST_OPTIMUM(Pose)                                                              \
  template RobustOptimum optimize_with_weights(PoseGraph<Pose>&, const std::vector<bool>&,          \
                                               std::vector<double>, const OptimizerParams&,         \
                                               const Progress&);                                    \
  template RobustOptimum optimize_with_outliers(PoseGraph<Pose>&, const std::vector<bool>&, double, \
                                                GivenValues, const OptimizerParams&, const Progress&);
RADIOSLAM_ROBUST_OPTIMUM(SE2)
RADIOSLAM_ROBUST_OPTIMUM(SE3)
#undef RADIOSLAM_ROBUST_OPTIMUM

}  // namespace radioslam

#include "radioslam/places/loops/scan_loops.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/places/keyframe_contexts.hpp"
#include "radioslam/places/loops/loop_verification.hpp"
#include "radioslam/places/stretches/stretch_loops.hpp"

namespace radioslam {
namespace {

constexpr double kLossScale = 4.1;  // root of chi-squared of 6 at 99 %

/// Without motions that nothing measured, over which only closures join the parts of a trajectory.
PoseGraph<SE3> odometry_graph(const ScanKeyframes& keyframes) {
  PoseGraph<SE3> graph;
  graph.poses = keyframes.poses;
  for (std::size_t k = 0; k + 1 < keyframes.poses.size(); ++k) {
    if (is_unknown_motion(keyframes.step_covariances[k])) continue;
    RelativePoseFactor<SE3> factor;
    factor.i = PoseId(k);
    factor.j = PoseId(k + 1);
    factor.T_i_j = keyframes.poses[k].inverse() * keyframes.poses[k + 1];
    factor.information = inverse(keyframes.step_covariances[k]);
    graph.relative_poses.push_back(factor);
  }
  return graph;
}

std::vector<ScanLoop> verify(const std::vector<LoopCandidate>& candidates,
                             const LoopVerification& verification, const PlacedKeyframes& robot) {
  std::vector<ScanLoop> loops(candidates.size());
  parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [i, j, T_i_j] = candidates[k];
      loops[k] = verification.verify(robot, i, robot, j, {T_i_j});
    }
  });
  return loops;
}

ScanContextIndex index_of(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                          const ScanLoopSearch& search) {
  const double given_m = search.descriptors.context.max_range_m;
  return keyframe_index(keyframes, path_m, given_m > 0 ? given_m : context_range(keyframes),
                        search.loops.submap_m, search.descriptors);
}

/// Between stretches that no closure of these, nor of those tried now, closes.
void add_stretches(StretchLoops& stretches, PlacedKeyframes robot, std::vector<ScanLoop> known,
                   std::vector<ScanLoop>& tried) {
  known.insert(known.end(), tried.begin(), tried.end());
  robot.submaps = std::make_shared<KeptSubmaps>();  // these are longer
  const std::vector<ScanLoop> of_stretches = stretches.find(robot, known);
  tried.insert(tried.end(), of_stretches.begin(), of_stretches.end());
}

/// Replaces what was said of the same pairs before.
void take_over(std::vector<ScanLoop> tried, std::vector<ScanLoop>& loops) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const ScanLoop& loop : tried) pairs.insert({loop.i, loop.j});
  std::erase_if(loops, [&](const ScanLoop& loop) { return pairs.contains({loop.i, loop.j}); });
  loops.insert(loops.end(), tried.begin(), tried.end());
}

/// Optimizes with all accepted closures and rejects those that contradict the others.
void optimize_and_prune(PoseGraph<SE3>& graph, std::size_t steps, std::vector<ScanLoop>& loops,
                        const Progress& progress) {
  graph.relative_poses.resize(steps);
  std::vector<std::size_t> loop_of_factor;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (loops[k].status != LoopStatus::kAccepted) continue;
    RelativePoseFactor<SE3> factor;
    factor.i = PoseId(loops[k].i);
    factor.j = PoseId(loops[k].j);
    factor.T_i_j = loops[k].T_i_j;
    factor.information = loops[k].information;
    factor.loss = {LossKind::kGemanMcClure, kLossScale};
    graph.relative_poses.push_back(factor);
    loop_of_factor.push_back(k);
  }
  const FactorMask mask = geman_mcclure_factors(graph);
  const auto summary =
      optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {}, progress);
  apply_weights(summary.weights, mask, graph);
  for (std::size_t f = steps; f < graph.relative_poses.size(); ++f)
    if (graph.relative_poses[f].weight < 0.5)
      loops[loop_of_factor[f - steps]].status = LoopStatus::kRejectedByGraph;
}

}  // namespace

ScanLoops close_scan_loops(const ScanKeyframes& keyframes, const ScanLoopSearch& search,
                           const Progress& progress, const ScanLoops* before) {
  const ScanLoopParams& params = search.loops;
  if (!params.enabled || keyframes.poses.size() < 2) return {{}, keyframes.poses};
  PoseGraph<SE3> graph = odometry_graph(keyframes);
  const std::size_t steps = graph.relative_poses.size();
  LoopCandidates candidates(keyframes, params, before ? before->tried : TriedPairs());
  const LoopVerification verification(params, {.target_m = params.submap_m, .storeys = search.storeys},
                                      search.map, search.pose, search.registration);
  const LoopVerification registration(
      params,
      {.target_m = StretchLoops::kHalf_m, .source_m = StretchLoops::kHalf_m / 2, .storeys = search.storeys},
      search.map, search.pose, search.registration);
  std::optional<StretchLoops> stretches;
  if (keyframes.kind == ScannerKind::kPlanar) stretches.emplace(keyframes, candidates, registration, params);
  std::optional<ScanContextIndex> index;
  ScanLoops result;
  if (before && !before->loops.empty()) {
    result.loops = before->loops;
    for (ScanLoop& loop : result.loops)
      if (loop.status == LoopStatus::kRejectedByGraph) loop.status = LoopStatus::kAccepted;
    optimize_and_prune(graph, steps, result.loops, progress);
  }
  for (int round = 0; round < params.rounds; ++round) {
    std::vector<LoopCandidate> found = candidates.find(graph);
    const auto reaches_elsewhere = [&](const LoopCandidate& candidate) {
      return verification.reaches_elsewhere({candidate.T_i_j},
                                            keyframes.clouds[candidate.j].median_range_m());
    };
    if (stretches)
      std::erase_if(found, [&](const LoopCandidate& candidate) {
        return stretches->covers(candidate.i, candidate.j) && reaches_elsewhere(candidate);
      });
    result.has_left_out = candidates.leave_out(search.most - result.registrations, graph, found);
    result.registrations += found.size();
    if (!index && std::any_of(found.begin(), found.end(), reaches_elsewhere))
      index = index_of(keyframes, candidates.path_m(), search);
    const PlacedKeyframes robot{keyframes, graph.poses, candidates.path_m(), index ? &*index : nullptr,
                                [&](std::size_t a, std::size_t b) { return candidates.sigma_m(a, b); }};
    std::vector<ScanLoop> tried = verify(found, verification, robot);
    for (const ScanLoop& loop : tried) candidates.note(loop);
    if (stretches && candidates.has_covariances() && result.registrations < search.most) {
      add_stretches(*stretches, robot, result.loops, tried);
      result.registrations = std::min(search.most, result.registrations + tried.size() - found.size());
    }
    take_over(tried, result.loops);
    if (std::none_of(tried.begin(), tried.end(),
                     [](const ScanLoop& loop) { return loop.status == LoopStatus::kAccepted; }))
      break;
    optimize_and_prune(graph, steps, result.loops, progress);
  }
  result.poses = std::move(graph.poses);
  result.tried = candidates.tried();
  return result;
}

}  // namespace radioslam

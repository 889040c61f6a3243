// Optimum of a pose graph some of whose relative poses may be wrong: graduated non-convexity with truncated
// least squares (graduated.hpp), min sum over candidates of min(s, gate), s the squared Mahalanobis norm.
// Source: Yang, Antonante, Tzoumas, Carlone 2020.
// It starts from the cheapest of the initial values (initial_values.hpp) and of the relative poses that are
// trusted alone, where candidates count by Geman and McClure's loss of the gate's width. Several candidates
// between the same two poses are hardly independent: together they weigh as one.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {

struct RobustOptimum {
  OptimizerSummary summary;     ///< of the last solution, with the weights; its initial cost is the start's
  InitialCosts start;           ///< `chosen` is kSpanningTree where it was that of the trusted ones
  std::vector<double> weights;  ///< per relative pose, 0 or 1: whether it is right; 1 for trusted ones
};

/// The optimum of the relative poses with weight 1, from the graph's poses. `weights`: 0 or 1 each.
template <class Pose>
RobustOptimum optimize_with_weights(PoseGraph<Pose>& graph, const std::vector<bool>& candidates,
                                    std::vector<double> weights, const OptimizerParams& params,
                                    const Progress& progress = {});

/// Moves the graph's poses there. `candidates`: per relative pose, whether it may be wrong.
template <class Pose>
RobustOptimum optimize_with_outliers(PoseGraph<Pose>& graph, const std::vector<bool>& candidates, double gate,
                                     GivenValues given, const OptimizerParams& params,
                                     const Progress& progress = {});

}  // namespace radioslam

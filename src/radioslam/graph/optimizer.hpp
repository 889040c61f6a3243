// Gauss-Newton / Levenberg-Marquardt on the manifold over a pose graph, with robust losses.
// Each step solves (H + damping * diag(H)) step = -g; damping starts at zero and is raised only when a step
// fails (Levenberg 1944; Marquardt 1963 for the diagonal). Undamped steps may raise the cost for a while, as
// Gauss-Newton's often do before they converge: the best values seen are kept and returned (the watchdog of
// Chamberlain et al. 1982). Gauge: gauge.hpp.
#pragma once

#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// When to stop and how far to trust a step.
struct OptimizerParams {
  int max_iterations = 100;
  double relative_cost_tolerance = 1e-9;
  double absolute_cost_tolerance = 1e-12;
  int nonmonotone_window = 3;
  double nonmonotone_growth = 100;
  double first_damping = 1e-4;
  double damping_factor = 10;
  double negligible_damping = 1e-8;
  double max_damping = 1e8;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(max_iterations, "", 0, 1e6, "largest number of optimizer steps");
    RADIOSLAM_BASIC_FIELD(relative_cost_tolerance, "", 0, 1,
                          "relative cost decrease of a full step below which the optimizer stops");
    RADIOSLAM_FIELD(absolute_cost_tolerance, "", 0, 1e6,
                    "absolute cost decrease of a full step below which the optimizer stops");
    RADIOSLAM_FIELD(nonmonotone_window, "", 0, 100,
                    "largest number of consecutive undamped steps that may stay above the best cost");
    RADIOSLAM_FIELD(nonmonotone_growth, "", 1, 1e12,
                    "largest cost that undamped steps may reach, as a multiple of the best cost");
    RADIOSLAM_FIELD(first_damping, "", 1e-12, 1e6,
                    "damping after the first failed step, as a multiple of diag(H)");
    RADIOSLAM_FIELD(damping_factor, "", 1.1, 1000,
                    "factor by which damping rises after a failed step and falls after a good one");
    RADIOSLAM_FIELD(negligible_damping, "", 0, 1, "damping below which a step counts as undamped");
    RADIOSLAM_FIELD(max_damping, "", 1, 1e20, "damping beyond which the optimizer gives up");
  }
};

/// How an optimization ended.
enum class Termination {
  kConverged,      ///< the last step changed the cost by less than the tolerance
  kMaxIterations,  ///< the estimate is the best seen, and may still improve
  kNoProgress,     ///< no damping gave a lower cost; the estimate is the best seen
  kNothingToDo,    ///< no free variable or no factor
};
std::string_view to_string(Termination termination);

/// Costs are sums of squared Mahalanobis norms (through the loss), without a factor of one half.
struct OptimizerSummary {
  double initial_cost = 0;
  double final_cost = 0;  ///< the best seen, at the values returned
  int iterations = 0;     ///< linear systems solved
  Termination termination = Termination::kConverged;
  std::vector<double> costs;  ///< per iteration, the initial one first; rejected steps included
};

/// The cost at the graph's current values.
template <class Pose>
double total_cost(const PoseGraph<Pose>& graph);

/// Moves graph.poses, points and drifts to a (local) minimum of the cost.
template <class Pose>
OptimizerSummary optimize(PoseGraph<Pose>& graph, const OptimizerParams& params,
                          const Progress& progress = {});

template <class Pose>
class NormalEquations;

/// The same with normal equations made for this graph's structure, for a row of optimizations that differ in
/// values, weights and losses only.
template <class Pose>
OptimizerSummary optimize(PoseGraph<Pose>& graph, NormalEquations<Pose>& equations,
                          const OptimizerParams& params, const Progress& progress = {});

}  // namespace radioslam

#include "radioslam/graph/optimizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/loss.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Fractions of an undamped step that are tried if the full step fails, and the smallest relative gain for
/// which one is accepted.
constexpr std::array kStepFractions = {0.6, 0.35, 0.2, 0.1, 0.03};
constexpr double kMinRelativeGain = 0.05;

/// One run: the graph holds the current values, `equations` are linearised at them.
template <class Pose>
class LevenbergMarquardt {
 public:
  LevenbergMarquardt(PoseGraph<Pose>& graph, NormalEquations<Pose>& equations, const OptimizerParams& params)
      : graph_(graph), equations_(equations), params_(params), best_(graph) {
    best_cost_ = equations_.linearise(graph_);
    summary_.initial_cost = best_cost_;
    summary_.costs.push_back(best_cost_);
  }

  OptimizerSummary run(const Progress& progress) {
    if (!std::isfinite(best_cost_)) return finish(Termination::kNoProgress);
    while (summary_.iterations < params_.max_iterations) {
      report_progress(progress, "optimize", summary_.iterations / double(params_.max_iterations));
      if (const auto end = iterate()) return finish(*end);
    }
    return finish(Termination::kMaxIterations);
  }

 private:
  /// One solve and what follows from it; a termination when that was the last.
  std::optional<Termination> iterate() {
    ++summary_.iterations;
    if (equations_.factorize(damping_) == Factorization::kNotPositiveDefinite) return on_singular_matrix();
    const Eigen::VectorXd step = equations_.step();
    if (!step.allFinite()) return on_singular_matrix();
    const double before = summary_.costs.back();
    const bool last = undamped() && negligible(equations_.predicted_decrease(step), before);
    equations_.apply(step, graph_);
    const double cost = last ? total_cost(graph_) : equations_.linearise(graph_);
    summary_.costs.push_back(cost);
    if (last) return try_final_step(cost);
    return accept_or_reject(cost);
  }

  bool undamped() const { return damping_ <= params_.negligible_damping; }
  bool negligible(double decrease, double cost) const {
    return decrease <=
           std::max(params_.relative_cost_tolerance * std::abs(cost), params_.absolute_cost_tolerance);
  }

  /// The model promises no more: take the step if it helps.
  std::optional<Termination> try_final_step(double cost) {
    if (cost <= best_cost_) {
      keep(cost);
      return Termination::kConverged;
    }
    // At the best values, a step that fails by rounding is the end; above them, go back.
    if (steps_above_best_ == 0 && negligible(cost - best_cost_, best_cost_)) return Termination::kConverged;
    return restore_best();
  }

  std::optional<Termination> accept_or_reject(double cost) {
    if (cost < best_cost_) {
      const bool small = undamped() && negligible(best_cost_ - cost, cost);
      keep(cost);
      lower_damping();
      return small ? std::optional(Termination::kConverged) : std::nullopt;
    }
    const bool may_stay_above_best = undamped() && steps_above_best_ < params_.nonmonotone_window &&
                                     cost <= params_.nonmonotone_growth * std::abs(best_cost_);
    if (!may_stay_above_best) return restore_best();
    ++steps_above_best_;
    return std::nullopt;
  }

  void keep(double cost) {
    best_ = GraphValues<Pose>(graph_);
    best_cost_ = cost;
    steps_above_best_ = 0;
  }

  std::optional<Termination> restore_best() {
    best_.restore(graph_);
    equations_.linearise(graph_);
    steps_above_best_ = 0;
    if (undamped() && try_shorter_steps()) return std::nullopt;
    return raise_damping(params_.first_damping);
  }

  /// Takes the best fraction of the undamped step from the best values, if the gain is sufficient. A large
  /// correction at the end of a long chain needs all its poses to move together: a shorter step does that,
  /// whereas damping holds each of them back.
  bool try_shorter_steps() {
    if (equations_.factorize(damping_) == Factorization::kNotPositiveDefinite) return false;
    ++summary_.iterations;
    const Eigen::VectorXd step = equations_.step();
    double best_ratio = 0, best_cost = best_cost_;
    for (const double fraction : kStepFractions) {
      equations_.apply(fraction * step, graph_);
      const double cost = total_cost(graph_);
      best_.restore(graph_);
      if (cost >= best_cost) continue;
      best_ratio = fraction;
      best_cost = cost;
    }
    const bool worthwhile = best_cost < (1 - kMinRelativeGain) * best_cost_;
    if (worthwhile) {
      equations_.apply(best_ratio * step, graph_);
      equations_.linearise(graph_);
      keep(best_cost);
    }
    summary_.costs.push_back(best_cost_);
    return worthwhile;
  }

  /// From now on some damping stays: the matrix is singular without.
  std::optional<Termination> on_singular_matrix() {
    summary_.costs.push_back(summary_.costs.back());
    min_damping_ = params_.negligible_damping;
    return raise_damping(params_.negligible_damping);
  }

  std::optional<Termination> raise_damping(double first) {
    damping_ = std::max(first, damping_ * params_.damping_factor);
    return damping_ > params_.max_damping ? std::optional(Termination::kNoProgress) : std::nullopt;
  }

  void lower_damping() {
    damping_ /= params_.damping_factor;
    if (damping_ < params_.negligible_damping) damping_ = min_damping_;
  }

  OptimizerSummary finish(Termination termination) {
    best_.restore(graph_);
    summary_.final_cost = best_cost_;
    summary_.termination = termination;
    return std::move(summary_);
  }

  PoseGraph<Pose>& graph_;
  NormalEquations<Pose>& equations_;
  const OptimizerParams& params_;
  GraphValues<Pose> best_;
  double best_cost_ = 0;
  double damping_ = 0, min_damping_ = 0;
  int steps_above_best_ = 0;
  OptimizerSummary summary_;
};

}  // namespace

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kMaxIterations:
      return "iteration limit";
    case Termination::kNoProgress:
      return "no progress";
    case Termination::kNothingToDo:
      return "nothing to do";
  }
  return "unknown";
}

template <class Pose>
double total_cost(const PoseGraph<Pose>& graph) {
  double cost = 0;
  for_each_factor(graph, [&](const auto& factor) {
    cost += evaluate(loss(factor), weight(factor) * squared_norm(graph, factor)).cost;
  });
  return cost;
}

template <class Pose>
OptimizerSummary optimize(PoseGraph<Pose>& graph, NormalEquations<Pose>& equations,
                          const OptimizerParams& params, const Progress& progress) {
  if (equations.empty()) {
    const double cost = total_cost(graph);
    return {cost, cost, 0, Termination::kNothingToDo, {cost}};
  }
  return LevenbergMarquardt<Pose>(graph, equations, params).run(progress);
}

template <class Pose>
OptimizerSummary optimize(PoseGraph<Pose>& graph, const OptimizerParams& params, const Progress& progress) {
  NormalEquations<Pose> equations(graph);
  return optimize(graph, equations, params, progress);
}

#define RADIOSLAM_OPTIMIZE(Pose)                                                                       \
  template double total_cost(const PoseGraph<Pose>&);                                                  \
  template OptimizerSummary optimize(PoseGraph<Pose>&, const OptimizerParams&, const Progress&);       \
  template OptimizerSummary optimize(PoseGraph<Pose>&, NormalEquations<Pose>&, const OptimizerParams&, \
                                     const Progress&);
RADIOSLAM_OPTIMIZE(SE2)
RADIOSLAM_OPTIMIZE(SE3)
#undef RADIOSLAM_OPTIMIZE

}  // namespace radioslam

#include "radioslam/graph/graduated.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Calls body(list of factors, its part of `parts`) for the five lists that may hold outliers.
template <class Graph, class Body, class... Parts>
void for_each_outlier_list(Graph& graph, Body&& body, Parts&... parts) {
  body(graph.relative_poses, parts.relative_poses...);
  body(graph.ranges, parts.ranges...);
  body(graph.bearings, parts.bearings...);
  body(graph.relative_points, parts.relative_points...);
  body(graph.positions, parts.positions...);
}

/// A run over one graph: `work_` is the weighted problem without the candidates' losses.
template <class Pose>
class Graduation {
 public:
  Graduation(const PoseGraph<Pose>& graph, const FactorMask& mask, GraduatedLoss loss,
             const GraduatedParams& params, const OptimizerParams& optimizer)
      : original_(graph),
        mask_(mask),
        loss_(loss),
        params_(params),
        optimizer_(optimizer),
        work_(graph),
        equations_(graph) {
    set_weights([](double, double) { return 1.0; });
    round_optimizer_ = optimizer;
    round_optimizer_.max_iterations = std::min(params.steps_per_round, optimizer.max_iterations);
  }

  GraduatedSummary run(const Progress& progress) {
    iterate(round_optimizer_);  // outliers distort the unweighted optimum: not solved to convergence
    start_mu();
    while (!settled() && summary_.rounds < params_.max_rounds) {
      ++summary_.rounds;
      report_progress(progress, "graduate", summary_.rounds / static_cast<double>(params_.max_rounds));
      set_weights([&](double s, double c2) { return surrogate_weight(loss_, mu_, s, c2); });
      iterate(round_optimizer_);
      mu_ = loss_ == GraduatedLoss::kGemanMcClure ? std::max(1.0, mu_ / params_.mu_factor)
                                                  : mu_ * params_.mu_factor;
    }
    finish();
    return std::move(summary_);
  }

  const PoseGraph<Pose>& work() const { return work_; }

 private:
  /// Calls body(weight, s, c^2) with a candidate's weight, to read or set, and its squared norm.
  template <class Body>
  void for_each_candidate(Body&& body) {
    for_each_outlier_list(
        original_,
        [&](const auto& factors, const auto& mask, auto& weights) {
          for (std::size_t k = 0; k < mask.size(); ++k) {
            if (!mask[k]) continue;
            const auto& f = factors[k];
            body(weights[k], f.weight * squared_norm(work_, f), f.loss.scale * f.loss.scale);
          }
        },
        mask_, summary_.weights);
  }

  /// weight_of(s, c^2) for every candidate; the weights go into `work_`.
  template <class WeightOf>
  void set_weights(const WeightOf& weight_of) {
    for_each_outlier_list(
        original_, [](const auto& factors, auto& weights) { weights.resize(factors.size(), 1); },
        summary_.weights);
    for_each_candidate([&](double& weight, double s, double c2) { weight = weight_of(s, c2); });
    work_.relative_poses = original_.relative_poses;
    work_.ranges = original_.ranges;
    work_.bearings = original_.bearings;
    work_.relative_points = original_.relative_points;
    work_.positions = original_.positions;
    apply_weights(summary_.weights, mask_, work_);
  }

  /// From the last round's values, or from the first ones where these fit the new weights better: an early
  /// round, distorted by outliers, may have left the basin of the first values.
  void iterate(const OptimizerParams& params) {
    PoseGraph<Pose> start = work_;
    GraphValues<Pose>(original_).restore(start);
    if (total_cost(start) < total_cost(work_)) work_ = std::move(start);
    summary_.last = optimize(work_, equations_, params);
    summary_.iterations += summary_.last.iterations;
  }

  double largest_ratio() {
    double largest = 0;
    for_each_candidate([&](double, double s, double c2) { largest = std::max(largest, s / c2); });
    return largest;
  }

  /// Where the surrogate is convex over all residuals; nothing to graduate when all are small.
  void start_mu() {
    const double ratio = largest_ratio();
    if (loss_ == GraduatedLoss::kGemanMcClure)
      mu_ = std::max(1.0, 2 * ratio);
    else
      mu_ = ratio > 1 ? 1 / (2 * ratio - 1) : 0;
  }

  bool settled() {
    if (loss_ == GraduatedLoss::kGemanMcClure) return summary_.rounds > 0 && mu_ == 1;
    if (mu_ == 0) return true;
    if (summary_.rounds == 0) return false;
    bool binary = true;
    for_each_candidate([&](double w, double, double) {
      binary = binary && std::min(w, 1 - w) <= params_.settled_weight_gap;
    });
    return binary;
  }

  /// To the end: at the loss itself for Geman-McClure, with the last weights, rounded, for the truncated one.
  void finish() {
    if (loss_ == GraduatedLoss::kGemanMcClure) {
      use_losses();
      iterate(optimizer_);
      for_each_candidate(
          [&](double& weight, double s, double c2) { weight = surrogate_weight(loss_, 1, s, c2); });
      return;
    }
    set_weights([&](double s, double c2) { return s <= c2 ? 1.0 : 0.0; });
    iterate(optimizer_);
  }

  void use_losses() {
    for_each_outlier_list(
        work_,
        [](auto& factors, const auto& originals, const auto& mask) {
          for (std::size_t k = 0; k < mask.size(); ++k) {
            if (!mask[k]) continue;
            factors[k] = originals[k];
            factors[k].loss.kind = LossKind::kGemanMcClure;
          }
        },
        original_, mask_);
  }

  const PoseGraph<Pose>& original_;
  const FactorMask& mask_;
  GraduatedLoss loss_;
  const GraduatedParams& params_;
  const OptimizerParams& optimizer_;
  OptimizerParams round_optimizer_;
  PoseGraph<Pose> work_;
  NormalEquations<Pose> equations_;
  double mu_ = 1;
  GraduatedSummary summary_;
};

}  // namespace

double surrogate_weight(GraduatedLoss loss, double mu, double s, double c2) {
  if (loss == GraduatedLoss::kGemanMcClure) {
    const double ratio = mu * c2 / (s + mu * c2);
    return ratio * ratio;
  }
  if (s <= c2 * mu / (mu + 1)) return 1;
  if (s >= c2 * (mu + 1) / mu) return 0;
  return std::sqrt(c2 * mu * (mu + 1) / s) - mu;
}

template <class Pose>
FactorMask geman_mcclure_factors(const PoseGraph<Pose>& graph) {
  FactorMask mask;
  for_each_outlier_list(
      graph,
      [](const auto& factors, std::vector<bool>& list) {
        for (const auto& f : factors) list.push_back(f.loss.kind == LossKind::kGemanMcClure);
      },
      mask);
  return mask;
}

template <class Pose>
void apply_weights(const FactorWeights& weights, const FactorMask& mask, PoseGraph<Pose>& graph) {
  for_each_outlier_list(
      graph,
      [](auto& factors, const auto& list, const auto& chosen) {
        RADIOSLAM_CHECK(chosen.empty() || chosen.size() == factors.size(),
                        "a mask needs one entry per factor");
        for (std::size_t k = 0; k < chosen.size(); ++k) {
          if (!chosen[k]) continue;
          factors[k].weight *= list[k];
          factors[k].loss = Loss{LossKind::kNone, factors[k].loss.scale};
        }
      },
      weights, mask);
}

template <class Pose>
GraduatedSummary optimize_graduated(PoseGraph<Pose>& graph, const FactorMask& mask, GraduatedLoss loss,
                                    const GraduatedParams& params, const OptimizerParams& optimizer,
                                    const Progress& progress) {
  Graduation<Pose> graduation(graph, mask, loss, params, optimizer);
  GraduatedSummary summary = graduation.run(progress);
  GraphValues<Pose>(graduation.work()).restore(graph);
  return summary;
}

#define RADIOSLAM_GRADUATED(Pose)                                                                  \
  template FactorMask geman_mcclure_factors(const PoseGraph<Pose>&);                               \
  template void apply_weights(const FactorWeights&, const FactorMask&, PoseGraph<Pose>&);          \
  template GraduatedSummary optimize_graduated(PoseGraph<Pose>&, const FactorMask&, GraduatedLoss, \
                                               const GraduatedParams&, const OptimizerParams&,     \
                                               const Progress&);
RADIOSLAM_GRADUATED(SE2)
RADIOSLAM_GRADUATED(SE3)
#undef RADIOSLAM_GRADUATED

}  // namespace radioslam

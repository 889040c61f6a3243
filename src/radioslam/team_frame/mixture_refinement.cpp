#include "radioslam/team_frame/mixture_refinement.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {
namespace {

/// Scales of the inflation per stage, from coarse to none.
constexpr std::array kCoarseScales = {1.0, 0.5, 0.25};
constexpr std::array kFineScales = {0.1, 0.03, 0.0};
/// Fractions of a Gauss-Newton step that are tried. A shorter step scales the correction of the whole
/// trajectory, whereas damping by diag(H) would tie every pose to its neighbours.
constexpr std::array kStepLengths = {1.0, 0.5, 0.2, 0.05, 0.01};
constexpr double kCoarseTolerance = 0.1;  // sufficient to rank initial values
constexpr int kShareRounds = 5;
constexpr int kStagesAlike = 2;  // fine stages that without an inflation are rounds like the others
constexpr double kShareTolerance = 0.01;
constexpr std::array kDampings = {0.0, 1e-6, 1e-3};

template <class Pose>
class Stage {
 public:
  Stage(MixtureGraph<Pose>& mixture, NormalEquations<Pose>& equations, const VarianceInflation& inflation)
      : mixture_(mixture), equations_(equations), inflation_(inflation) {}

  /// At most `steps` steps at this scale of the inflation; returns the cost.
  double run(double inflation_scale, int steps, double tolerance) {
    cost_ = mixture_.update_weights(inflation_, inflation_scale);
    for (int k = 0; k < steps; ++k) {
      const double before = cost_;
      if (!step(inflation_scale) || before - cost_ < tolerance) break;
    }
    return cost_;
  }

 private:
  /// Takes one step that lowers the cost; false if none does.
  bool step(double inflation_scale) {
    equations_.linearise(mixture_.graph);
    const GraphValues<Pose> start(mixture_.graph);
    for (const double damping : kDampings) {
      if (equations_.factorize(damping) == Factorization::kNotPositiveDefinite) continue;
      const Eigen::VectorXd step = equations_.step();
      if (!step.allFinite()) continue;
      for (const double length : kStepLengths) {
        equations_.apply(length * step, mixture_.graph);
        // Most steps are taken, so their weights are computed with the cost.
        const double cost = mixture_.update_weights(inflation_, inflation_scale);
        if (cost <= cost_) {
          cost_ = cost;
          return true;
        }
        start.restore(mixture_.graph);
      }
    }
    mixture_.update_weights(inflation_, inflation_scale);
    return false;
  }

  MixtureGraph<Pose>& mixture_;
  NormalEquations<Pose>& equations_;
  const VarianceInflation& inflation_;
  double cost_ = 0;
};

/// The stages of an inflation, from coarse to none; returns the cost.
template <class Pose>
double refine_by_inflation(MixtureGraph<Pose>& mixture, Stage<Pose>& stage,
                           const VarianceInflation& inflation, const RefinementParams& params) {
  double cost = 0;
  for (const double inflation_scale : kCoarseScales)
    stage.run(inflation_scale, params.steps_per_inflation, params.cost_tolerance);
  for (const double inflation_scale : kFineScales) {
    mixture.estimate_obstructed_share(inflation, inflation_scale);
    cost = stage.run(inflation_scale, inflation_scale > 0 ? params.steps_per_inflation : params.last_steps,
                     params.cost_tolerance);
  }
  return cost;
}

/// As many steps without an inflation, which makes its stages all alike: they end where they have converged.
template <class Pose>
double refine_without_inflation(MixtureGraph<Pose>& mixture, Stage<Pose>& stage,
                                const RefinementParams& params) {
  const int coarse = static_cast<int>(kCoarseScales.size()) * params.steps_per_inflation;
  stage.run(0, coarse, params.cost_tolerance);
  mixture.estimate_obstructed_share({}, 0);
  return stage.run(0, params.last_steps, params.cost_tolerance);
}

/// Estimates the share of obstructed links and the values in turn; returns the cost.
template <class Pose>
double refine_in_turn(MixtureGraph<Pose>& mixture, Stage<Pose>& stage, double cost, int rounds,
                      const RefinementParams& params) {
  for (int round = 0; round < rounds; ++round) {
    mixture.estimate_obstructed_share({}, 0);
    const double before = cost;
    cost = stage.run(0, params.last_steps, params.cost_tolerance);
    if (std::abs(before - cost) < kShareTolerance) break;
  }
  return cost;
}

}  // namespace

template <class Pose>
Refinement refine(MixtureGraph<Pose>& mixture, const VarianceInflation& inflation,
                  const RefinementParams& params) {
  NormalEquations<Pose> equations(mixture.graph);
  Refinement result;
  if (equations.empty()) {
    result.cost = mixture.update_weights(inflation, 0);
    result.log_evidence = -result.cost / 2;
    return result;
  }
  Stage<Pose> stage(mixture, equations, inflation);
  const bool is_inflated = !inflation.ranges_m2.empty() || !inflation.bearings_rad2.empty();
  result.cost = is_inflated ? refine_by_inflation(mixture, stage, inflation, params)
                            : refine_without_inflation(mixture, stage, params);
  result.cost = refine_in_turn(mixture, stage, result.cost,
                               is_inflated ? kShareRounds : kShareRounds + kStagesAlike, params);
  equations.linearise(mixture.graph);
  if (equations.factorize(0) == Factorization::kDone)
    result.log_evidence = -result.cost / 2 - equations.cholesky().log_determinant() / 2;
  else
    result.log_evidence = -std::numeric_limits<double>::infinity();
  return result;
}

template <class Pose>
double refine_coarsely(MixtureGraph<Pose>& mixture, const VarianceInflation& inflation,
                       const RefinementParams& params) {
  NormalEquations<Pose> equations(mixture.graph);
  if (equations.empty()) return mixture.update_weights(inflation, kCoarseScales.back());
  Stage<Pose> stage(mixture, equations, inflation);
  double cost = 0;
  for (const double inflation_scale : kCoarseScales)
    cost = stage.run(inflation_scale, params.steps_per_inflation, kCoarseTolerance);
  return cost;
}

template double refine_coarsely(MixtureGraph<SE2>&, const VarianceInflation&, const RefinementParams&);
template double refine_coarsely(MixtureGraph<SE3>&, const VarianceInflation&, const RefinementParams&);
template Refinement refine(MixtureGraph<SE2>&, const VarianceInflation&, const RefinementParams&);
template Refinement refine(MixtureGraph<SE3>&, const VarianceInflation&, const RefinementParams&);

}  // namespace radioslam

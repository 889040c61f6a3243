#include "radioslam/team_frame/mixture_refinement.hpp"

#include <array>
#include <limits>

#include "radioslam/graph/graph_values.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {
namespace {

/// Shares of the inflation, from the coarse start to none.
constexpr std::array kCoarseShares = {1.0, 0.5, 0.25};
constexpr std::array kFineShares = {0.1, 0.03, 0.0};
/// Shares of a Gauss-Newton step that are tried. Along a chain of odometry a shorter step bends the whole
/// way a little less, where damping by diag(H) would hold every pose to its neighbours.
constexpr std::array kStepShares = {1.0, 0.5, 0.2, 0.05, 0.01};
constexpr double kCoarseTolerance = 0.1;  // nothing a choice among starts depends on
constexpr std::array kDampings = {0.0, 1e-6, 1e-3};

template <class Pose>
class Stage {
 public:
  Stage(MixtureGraph<Pose>& mixture, NormalEquations<Pose>& equations, const Inflation& inflation)
      : mixture_(mixture), equations_(equations), inflation_(inflation) {}

  /// At most `steps` steps with this share of the inflation; returns the cost.
  double run(double share, int steps, double tolerance) {
    cost_ = mixture_.reweigh(inflation_, share);
    for (int k = 0; k < steps; ++k) {
      const double before = cost_;
      if (!step(share) || before - cost_ < tolerance) break;
    }
    return cost_;
  }

 private:
  /// One step that lowers the cost; false where none does.
  bool step(double share) {
    equations_.linearise(mixture_.graph);
    const GraphValues<Pose> start(mixture_.graph);
    for (const double damping : kDampings) {
      if (equations_.factorize(damping) == Factorization::kNotPositiveDefinite) continue;
      const Eigen::VectorXd step = equations_.step();
      if (!step.allFinite()) continue;
      for (const double length : kStepShares) {
        equations_.apply(length * step, mixture_.graph);
        const double cost = mixture_.cost(inflation_, share);
        if (cost <= cost_) {
          cost_ = mixture_.reweigh(inflation_, share);
          return true;
        }
        start.restore(mixture_.graph);
      }
    }
    return false;
  }

  MixtureGraph<Pose>& mixture_;
  NormalEquations<Pose>& equations_;
  const Inflation& inflation_;
  double cost_ = 0;
};

}  // namespace

template <class Pose>
Refinement refine(MixtureGraph<Pose>& mixture, const Inflation& inflation, const RefinementParams& params) {
  NormalEquations<Pose> equations(mixture.graph);
  Refinement result;
  if (equations.empty()) {
    result.cost = mixture.reweigh(inflation, 0);
    result.log_evidence = -result.cost / 2;
    return result;
  }
  Stage<Pose> stage(mixture, equations, inflation);
  for (const double share : kCoarseShares) stage.run(share, params.steps_per_share, params.cost_tolerance);
  for (const double share : kFineShares)
    result.cost =
        stage.run(share, share > 0 ? params.steps_per_share : params.last_steps, params.cost_tolerance);
  equations.linearise(mixture.graph);
  if (equations.factorize(0) == Factorization::kDone)
    result.log_evidence = -result.cost / 2 - equations.cholesky().log_determinant() / 2;
  else
    result.log_evidence = -std::numeric_limits<double>::infinity();
  return result;
}

template <class Pose>
double refine_coarsely(MixtureGraph<Pose>& mixture, const Inflation& inflation,
                       const RefinementParams& params) {
  NormalEquations<Pose> equations(mixture.graph);
  if (equations.empty()) return mixture.reweigh(inflation, kCoarseShares.back());
  Stage<Pose> stage(mixture, equations, inflation);
  double cost = 0;
  for (const double share : kCoarseShares) cost = stage.run(share, params.steps_per_share, kCoarseTolerance);
  return cost;
}

template double refine_coarsely(MixtureGraph<SE2>&, const Inflation&, const RefinementParams&);
template double refine_coarsely(MixtureGraph<SE3>&, const Inflation&, const RefinementParams&);
template Refinement refine(MixtureGraph<SE2>&, const Inflation&, const RefinementParams&);
template Refinement refine(MixtureGraph<SE3>&, const Inflation&, const RefinementParams&);

}  // namespace radioslam

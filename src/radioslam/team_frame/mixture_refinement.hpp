// Refines a team's poses under mixture likelihoods by expectation maximisation (Dempster, Laird and Rubin
// 1977): Gauss-Newton steps with step control on the posterior weights, while the measurements' variances are
// inflated at first and less at every stage, which widens the basin of convergence. A step is accepted only
// if it lowers the mixture's own cost.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

struct RefinementParams {
  int steps_per_inflation = 6;
  int last_steps = 40;
  double cost_tolerance = 1e-3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(steps_per_inflation, "", 1, 1000,
                    "largest number of steps at each inflation of the measurement variances except the last");
    RADIOSLAM_FIELD(last_steps, "", 1, 10000, "largest number of steps without variance inflation");
    RADIOSLAM_FIELD(cost_tolerance, "", 0, 100,
                    "smallest decrease of -2 log L per step; a stage ends below it");
  }
};

struct Refinement {
  double cost = 0;          ///< final -2 log L, without inflation
  double log_evidence = 0;  ///< log L - log det H / 2 (Laplace); comparable between refinements of one graph
};

/// Updates the values of `mixture.graph` and leaves its weights and sigmas at those of the final values.
template <class Pose>
Refinement refine(MixtureGraph<Pose>& mixture, const VarianceInflation& inflation,
                  const RefinementParams& params);

/// Runs only the first stages, with the largest inflation, to rank many initial values; returns the cost
/// there. `refine` may follow.
template <class Pose>
double refine_coarsely(MixtureGraph<Pose>& mixture, const VarianceInflation& inflation,
                       const RefinementParams& params);

}  // namespace radioslam

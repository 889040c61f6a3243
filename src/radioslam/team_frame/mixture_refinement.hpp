// Refines a team whose measurements may be wrong: Gauss-Newton with step control on the expected weights of
// the mixture (expectation-maximisation; Dempster, Laird and Rubin 1977), with the measurements' variances
// inflated at first and less and less, so that a coarse start is pulled in by all of them. A step counts only
// when it lowers the mixture's own cost.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

struct RefinementParams {
  int steps_per_share = 6;  ///< at each inflation but the last
  int last_steps = 40;
  double cost_tolerance = 1e-3;  ///< a stage ends when a step lowers -2 log L by less

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"steps_per_share", "", 1, 1000, "steps at each inflation of the variances but the last"},
          self.steps_per_share);
    visit(Field{"last_steps", "", 1, 10000, "steps at most without inflation"}, self.last_steps);
    visit(Field{"cost_tolerance", "", 0, 100, "a stage ends when a step lowers -2 log L by less"},
          self.cost_tolerance);
  }
};

struct Refinement {
  double cost = 0;          ///< -2 log L at the end, without inflation
  double log_evidence = 0;  ///< log L - log det H / 2 (Laplace); comparable between refinements of one graph
};

/// Moves the values of `mixture.graph`; its weights and sigmas are those of the end.
template <class Pose>
Refinement refine(MixtureGraph<Pose>& mixture, const Inflation& inflation, const RefinementParams& params);

/// The first, most inflated part of it alone, for choosing among many starts: returns the cost there.
/// `refine` may follow.
template <class Pose>
double refine_coarsely(MixtureGraph<Pose>& mixture, const Inflation& inflation,
                       const RefinementParams& params);

}  // namespace radioslam

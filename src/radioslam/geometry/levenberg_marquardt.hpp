// Levenberg-Marquardt minimisation of a cost over few variables with dense normal equations (Marquardt 1963):
//   move = -(H + damping diag H)^-1 g,
// accepted if the cost decreases. The damping shrinks after an accepted step and grows after a rejected one.
// Large sparse problems are minimised in graph/.
#pragma once

#include <type_traits>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

struct LevenbergMarquardtLimits {
  int max_steps = 30;
  double first_damping = 1e-3;
  double max_damping = 1e6;  ///< the iteration ends beyond it
  double damping_factor = 10;
  double settled = 1e-4;  ///< norm of an accepted move that is the last
};

/// A point with the objective there.
template <class Point, class Objective>
struct LocalMinimum {
  Point at;
  Objective objective;
};

/// Local minimum from `start`. `evaluate(point)` returns an objective with cost, gradient and information
/// (the Gauss-Newton Hessian); `moved(point, move)` applies a move of the gradient's type.
template <class Point, class Evaluate, class Moved>
auto levenberg_marquardt(const Point& start, const LevenbergMarquardtLimits& limits, Evaluate&& evaluate,
                         Moved&& moved) {
  using Objective = std::decay_t<decltype(evaluate(start))>;
  LocalMinimum<Point, Objective> best{start, evaluate(start)};
  double damping = limits.first_damping;
  for (int step = 0; step < limits.max_steps && damping < limits.max_damping; ++step) {
    auto damped = best.objective.information;
    damped.diagonal() *= 1 + damping;
    const decltype(best.objective.gradient) move = -ldlt_solve(damped, best.objective.gradient);
    if (!move.allFinite()) break;
    const Point at = moved(best.at, move);
    Objective objective = evaluate(at);
    const bool better = objective.cost < best.objective.cost;
    damping *= better ? 1 / limits.damping_factor : limits.damping_factor;
    if (!better) continue;
    best = {at, std::move(objective)};
    if (move.norm() < limits.settled) break;
  }
  return best;
}

}  // namespace radioslam

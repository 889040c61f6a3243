// Minimises a smooth function by limited-memory BFGS (Nocedal 1980; Liu and Nocedal 1989) with a backtracking
// line search (Armijo condition); pairs of negative curvature are dropped.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace radioslam {

struct ValueAndGradient {
  double value = 0;
  Eigen::VectorXd gradient;
};

using SmoothFunction = std::function<ValueAndGradient(const Eigen::VectorXd& x)>;

struct Minimum {
  Eigen::VectorXd x;
  double value = 0;
  int iterations = 0;
};

/// Stops after `max_iterations` or when an iteration lowers the value by less than `min_gain`. Variables
/// should be scaled to similar magnitude. A value that is not finite counts as infinitely high.
Minimum minimise_lbfgs(const SmoothFunction& function, const Eigen::VectorXd& start, int max_iterations,
                       double min_gain);

}  // namespace radioslam

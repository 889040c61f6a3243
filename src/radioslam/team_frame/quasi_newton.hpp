// The minimum of a smooth function of many variables by its gradient: limited-memory BFGS (Nocedal 1980; Liu
// and Nocedal 1989) with a line search that halves until the value falls enough (Armijo) and keeps only pairs
// that curve upwards.
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

/// Stops after `max_iterations`, or where an iteration gains less than `least_gain`. Variables should be of
/// one size. A value that is not finite counts as infinitely high.
Minimum minimise(const SmoothFunction& function, const Eigen::VectorXd& start, int max_iterations,
                 double least_gain);

}  // namespace radioslam

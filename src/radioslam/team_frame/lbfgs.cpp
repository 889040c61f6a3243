#include "radioslam/team_frame/lbfgs.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

namespace radioslam {
namespace {

constexpr std::size_t kMemory = 10;      // stored curvature pairs
constexpr double kEnoughDescent = 1e-4;  // Armijo constant
constexpr double kMinCurvature = 1e-10;
constexpr int kHalvings = 30;

/// A step and the change of gradient along it.
struct CurvaturePair {
  Eigen::VectorXd moved, gradient_change;
  double curvature = 0;  ///< dot product of the two
};

/// Search direction -H gradient by the two-loop recursion.
Eigen::VectorXd direction_of(const Eigen::VectorXd& gradient, const std::deque<CurvaturePair>& steps) {
  Eigen::VectorXd q = -gradient;
  std::vector<double> along(steps.size());
  for (std::size_t k = steps.size(); k-- > 0;) {
    along[k] = steps[k].moved.dot(q) / steps[k].curvature;
    q -= along[k] * steps[k].gradient_change;
  }
  if (!steps.empty()) q *= steps.back().curvature / steps.back().gradient_change.squaredNorm();
  for (std::size_t k = 0; k < steps.size(); ++k)
    q += (along[k] - steps[k].gradient_change.dot(q) / steps[k].curvature) * steps[k].moved;
  return q;
}

bool is_descent(const Eigen::VectorXd& direction, const Eigen::VectorXd& gradient) {
  const double slope = direction.dot(gradient);
  return std::isfinite(slope) && slope < 0;
}

}  // namespace

Minimum minimise_lbfgs(const SmoothFunction& function, const Eigen::VectorXd& start, int max_iterations,
                       double min_gain) {
  Minimum best{start, 0, 0};
  ValueAndGradient here = function(start);
  std::deque<CurvaturePair> steps;
  for (; best.iterations < max_iterations; ++best.iterations) {
    Eigen::VectorXd direction = direction_of(here.gradient, steps);
    if (!is_descent(direction, here.gradient)) {
      steps.clear();
      direction = -here.gradient;
    }
    double length = steps.empty() ? 1 / std::max(1.0, here.gradient.norm()) : 1;
    const double slope = direction.dot(here.gradient);
    ValueAndGradient there;
    int halvings = 0;
    for (; halvings < kHalvings; ++halvings, length /= 2) {
      there = function(best.x + length * direction);
      if (std::isfinite(there.value) && there.value <= here.value + kEnoughDescent * length * slope) break;
    }
    if (halvings == kHalvings) break;
    CurvaturePair step{length * direction, there.gradient - here.gradient, 0};
    step.curvature = step.moved.dot(step.gradient_change);
    best.x += step.moved;
    const double gain = here.value - there.value;
    here = std::move(there);
    if (step.curvature > kMinCurvature * step.gradient_change.squaredNorm()) {
      steps.push_back(std::move(step));
      if (steps.size() > kMemory) steps.pop_front();
    }
    if (gain < min_gain) break;
  }
  best.value = here.value;
  return best;
}

}  // namespace radioslam

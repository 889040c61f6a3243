#include "radioslam/radio/fingerprints/censored_loss.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace radioslam {
namespace {

constexpr double kLowest = -12, kHighest = 8, kPerStep = 32;

/// The functions at a point, and the hazard's slope; the cost's follows from the hazard.
struct Knot {
  double cost = 0, hazard = 0, hazard_slope = 0;
};

Knot knot_at(double z) {
  const double below = std::erfc(-z / std::numbers::sqrt2) / 2;
  const double hazard = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi) / below;
  return {-2 * std::log(below), hazard, -hazard * (hazard + z)};
}

std::vector<Knot> make_knots() {
  std::vector<Knot> knots;
  for (int k = 0; k <= static_cast<int>((kHighest - kLowest) * kPerStep); ++k)
    knots.push_back(knot_at(kLowest + k / kPerStep));
  return knots;
}

/// Between values a and b with slopes per step, at a ratio t of the step.
double hermite(double a, double slope_a, double b, double slope_b, double t) {
  const double rise = b - a, bend_a = slope_a - rise, bend_b = slope_b - rise;
  return a + t * (rise + (1 - t) * ((1 - t) * bend_a - t * bend_b));
}

}  // namespace

CensoredLoss censored_loss(double z) {
  static const std::vector<Knot> knots = make_knots();
  if (z >= kHighest) return {};
  if (!(z >= kLowest)) {
    const double beyond = kLowest - z;
    const Knot& lowest = knots.front();
    return {lowest.cost + beyond * (2 * lowest.hazard + beyond), lowest.hazard + beyond};
  }
  const double steps = (z - kLowest) * kPerStep;
  const std::size_t at = std::min(static_cast<std::size_t>(steps), knots.size() - 2);  // z + 12 may round up
  const Knot &a = knots[at], &b = knots[at + 1];
  const double t = steps - static_cast<double>(at);
  return {hermite(a.cost, -2 * a.hazard / kPerStep, b.cost, -2 * b.hazard / kPerStep, t),
          hermite(a.hazard, a.hazard_slope / kPerStep, b.hazard, b.hazard_slope / kPerStep, t)};
}

}  // namespace radioslam

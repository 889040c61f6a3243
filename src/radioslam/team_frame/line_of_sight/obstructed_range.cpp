#include "radioslam/team_frame/line_of_sight/obstructed_range.hpp"

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kTail = -5;  // below, phi / Phi follows from a continued fraction
constexpr int kTerms = 40;

/// phi(y) / Phi(y) + y; tends to -1 / y in the lower tail.
double hazard_and_argument(double y, double distribution) {
  if (y > kTail) return std::exp(-y * y / 2) / (std::sqrt(2 * std::numbers::pi) * distribution) + y;
  double fraction = 0;  // phi / Phi = t + 1 / (t + 2 / (t + 3 / ...)) with t = -y
  for (int k = kTerms; k > 0; --k) fraction = k / (-y + fraction);
  return fraction;
}

}  // namespace

double obstructed_probability(double x, double sigma) {
  return std::erfc(-(x / sigma) / std::numbers::sqrt2) / 2;
}

ObstructedRange obstructed_range(double x, double sigma) {
  const double y = x / sigma;
  ObstructedRange result;
  result.probability = obstructed_probability(x, sigma);
  const double sum = hazard_and_argument(y, result.probability), hazard = sum - y;
  result.slope = hazard / sigma;
  result.curvature = hazard * sum / (sigma * sigma);
  return result;
}

}  // namespace radioslam

#include "radioslam/consistency/chi_squared.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr int kMaxIterations = 100;  // halving alone reaches the last bit by then
constexpr double kSettled = 1e-15;   // relative step

/// y^(n/2) exp(-y) / Gamma(n/2 + 1).
double tail_term(double y, int n) {
  const double a = 0.5 * n;
  return std::exp(a * std::log(y) - y - std::lgamma(a + 1));
}

double density(double value, int dof) {
  const double a = 0.5 * dof;
  return 0.5 * std::exp((a - 1) * std::log(0.5 * value) - 0.5 * value - std::lgamma(a));
}

/// Wilson and Hilferty (1931): the cube root is nearly normal. The normal quantile by a few terms of its
/// tail's asymptotics is start enough.
double start_value(double tail, int dof) {
  const double t = std::sqrt(-2 * std::log(std::min(tail, 1 - tail)));
  const double normal =
      (tail < 0.5 ? 1 : -1) * (t - (2.30753 + 0.27061 * t) / (1 + t * (0.99229 + 0.04481 * t)));
  const double spread = 2.0 / (9.0 * dof);
  const double root = 1 - spread + normal * std::sqrt(spread);
  return dof * std::pow(std::max(root, 1e-3), 3);
}

}  // namespace

double chi_squared_tail(double value, int dof) {
  RADIOSLAM_CHECK(dof >= 1 && value >= 0, "a squared norm of at least one dimension");
  if (value == 0) return 1;
  const double y = 0.5 * value;
  double tail = dof % 2 == 1 ? std::erfc(std::sqrt(y)) : std::exp(-y);
  for (int n = dof % 2 == 1 ? 1 : 2; n < dof; n += 2) tail += tail_term(y, n);
  return tail;
}

double chi_squared_quantile(double probability, int dof) {
  RADIOSLAM_CHECK(probability > 0 && probability < 1, "a probability between 0 and 1");
  const double tail = 1 - probability;
  double low = 0, value = start_value(tail, dof), high = 2 * value + 1;
  while (chi_squared_tail(high, dof) > tail) high *= 2;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double excess = chi_squared_tail(value, dof) - tail;
    (excess > 0 ? low : high) = value;
    const double newton = value + excess / density(value, dof);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    const bool settled = std::abs(next - value) <= kSettled * value;
    value = next;
    if (settled) break;
  }
  return value;
}

}  // namespace radioslam

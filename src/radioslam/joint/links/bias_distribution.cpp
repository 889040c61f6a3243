#include "radioslam/joint/links/bias_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum over all sequences of (e_t - mean) (e_{t + lag} - mean).
double lagged_products(const std::vector<std::vector<double>>& sequences, std::size_t lag) {
  double sum = 0;
  for (const auto& e : sequences) {
    const double mean = e.empty() ? 0 : mean_of(e);
    for (std::size_t t = 0; t + lag < e.size(); ++t) sum += (e[t] - mean) * (e[t + lag] - mean);
  }
  return sum;
}

}  // namespace

double middle_of_shortest_half(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  double shortest = std::numeric_limits<double>::infinity(), middle = 0;
  for (std::size_t k = 0; k + half < values.size(); ++k) {
    const double length = values[k + half] - values[k];
    if (length >= shortest) continue;
    shortest = length;
    middle = (values[k + half] + values[k]) / 2;
  }
  return middle;
}

double correlation_time(const std::vector<std::vector<double>>& sequences) {
  const double variance = lagged_products(sequences, 0);
  std::size_t longest = 0;
  for (const auto& e : sequences) longest = std::max(longest, e.size());
  double time = 1;
  for (std::size_t lag = 1; lag < longest; ++lag) {
    const double product = lagged_products(sequences, lag);
    if (!(product > 0)) break;
    time += 2 * product / variance;
  }
  return time;
}

std::optional<BiasDistribution> bias_distribution(const std::vector<double>& biases_m,
                                                  const Eigen::MatrixXd& covariance,
                                                  double false_alarm_probability, double min_spread_m) {
  const Eigen::Map<const Eigen::VectorXd> b(biases_m.data(), covariance.rows());
  const auto n = static_cast<int>(b.size());
  if (b.dot(Cholesky<Eigen::MatrixXd>(covariance).solve(b)) <=
      chi_squared_quantile(1 - false_alarm_probability, n))
    return std::nullopt;
  const Eigen::ArrayXd w = covariance.diagonal().array().inverse();
  const double mean = (w * b.array()).sum() / w.sum();
  const double freedom = w.sum() - w.square().sum() / w.sum();
  const double spread2 = freedom > 0 ? ((w * (b.array() - mean).square()).sum() - (n - 1)) / freedom : 0;
  return BiasDistribution{mean, std::sqrt(std::max(spread2, std::pow(min_spread_m, 2)))};
}

}  // namespace radioslam

// Statistics of range biases: robust location, correlation time of residuals, and the distribution that
// significant biases are drawn from.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace radioslam {

/// Centre of the shortest interval that contains half of the values (shorth).
double middle_of_shortest_half(std::vector<double> values);

/// Number of successive values that count as one: 1 + 2 sum of the autocorrelations, over lags up to the
/// first that is not positive (Geyer 1992). The sequences' own means are subtracted.
double correlation_time(const std::vector<std::vector<double>>& sequences);

/// Normal distribution of the biases, metres.
struct BiasDistribution {
  double mean_m, sigma_m;
};

/// Distribution of the biases b with joint covariance `covariance` [m^2], nothing if they are not significant
/// at `false_alarm_probability`. Uses each bias's own variance v only, since covariances between biases
/// assume ranges without common errors. For b ~ N(m, v + s^2) and w = 1 / v (DerSimonian and Laird 1986):
/// m = sum w b / sum w, and s^2 from
///   E sum w (b - m)^2 = n - 1 + s^2 (sum w - sum w^2 / sum w),
/// at least min_spread_m squared.
std::optional<BiasDistribution> bias_distribution(const std::vector<double>& biases_m,
                                                  const Eigen::MatrixXd& covariance,
                                                  double false_alarm_probability, double min_spread_m);

}  // namespace radioslam

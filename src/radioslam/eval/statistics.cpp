#include "radioslam/eval/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"

namespace radioslam {

double quantile(const std::vector<double>& sorted, double fraction) {
  RADIOSLAM_CHECK(!sorted.empty() && fraction >= 0 && fraction <= 1,
                  "a quantile needs values and a fraction in [0, 1]");
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::optional<ErrorStatistics> summarise_errors(std::vector<double> errors_m) {
  if (errors_m.empty()) return std::nullopt;
  std::sort(errors_m.begin(), errors_m.end());
  ErrorStatistics statistics;
  statistics.count = errors_m.size();
  for (const double error : errors_m) {
    statistics.mean_m += error;
    statistics.rmse_m += error * error;
  }
  const auto count = static_cast<double>(errors_m.size());
  statistics.mean_m /= count;
  statistics.rmse_m = std::sqrt(statistics.rmse_m / count);
  statistics.median_m = quantile(errors_m, 0.5);
  statistics.p90_m = quantile(errors_m, 0.9);
  return statistics;
}

}  // namespace radioslam

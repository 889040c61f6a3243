// Summary statistics of a set of errors.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// Quantile of sorted values for a `fraction` in [0, 1], with linear interpolation (numpy's default). Needs
/// one value.
double quantile(const std::vector<double>& sorted, double fraction);

/// Nothing if there are no errors.
std::optional<ErrorStatistics> summarise_errors(std::vector<double> errors_m);

}  // namespace radioslam

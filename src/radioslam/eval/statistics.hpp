// Summaries of a set of errors.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {

/// The value below which `share` of the sorted values lie, linear between neighbours (numpy's default).
/// Needs one value; `share` in [0, 1].
double quantile(const std::vector<double>& sorted, double share);

/// Nothing for no errors.
std::optional<ErrorStatistics> summarise_errors(std::vector<double> errors_m);

}  // namespace radioslam

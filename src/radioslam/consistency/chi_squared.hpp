// The chi-squared distribution: how large a squared Mahalanobis norm of n dimensions may be.
// With a = n/2 the upper tail Q(a, x/2) follows from Q(1/2, y) = erfc(sqrt y), Q(1, y) = exp(-y) and
// Q(a + 1, y) = Q(a, y) + y^a exp(-y) / Gamma(a + 1)  (Abramowitz & Stegun 26.4): sums of positive terms.
// Cost: O(dof) per tail, a handful of tails per quantile.
#pragma once

namespace radioslam {

/// The probability of exceeding `value` >= 0. dof >= 1.
double chi_squared_tail(double value, int dof);

/// The value that is not exceeded with `probability`, 0 < probability < 1. Relative error below 1e-12 for
/// probabilities from 0.001 to 1 - 1e-9.
double chi_squared_quantile(double probability, int dof);

/// 99 % quantile for one degree of freedom.
inline constexpr double kChiSquared99 = 6.635;
/// 99 % chi-squared quantile for a relative pose: 3 or 6 degrees of freedom.
template <class Pose>
inline constexpr double kPoseChiSquared99 = Pose::kDof == 3 ? 11.345 : 16.812;
/// The same for 99.9 %.
template <class Pose>
inline constexpr double kPoseChiSquared999 = Pose::kDof == 3 ? 16.266 : 22.458;

}  // namespace radioslam

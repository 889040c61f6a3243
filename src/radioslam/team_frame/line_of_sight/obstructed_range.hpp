// Likelihood of a distance, given a range whose direct path is obstructed: the signal takes a detour, so that
// with an error of standard deviation s the range exceeds the distance by any length. With
// x = range - distance, the detour's density is multiplied by
//   Phi(x / s)
// which is log-concave and rejects distances that exceed the range. The excess of an exponential density
// would also pull the distance towards the range; where all links go round corners, that pull accumulates.
#pragma once

namespace radioslam {

struct ObstructedRange {
  double probability = 1;  ///< Phi(x / s)
  double slope = 0;        ///< d log Phi / dx
  double curvature = 0;    ///< -d^2 log Phi / dx^2, in (0, 1 / s^2)
};

/// The probability alone, which costs less. Both expect sigma > 0.
double obstructed_probability(double x, double sigma);
ObstructedRange obstructed_range(double x, double sigma);

}  // namespace radioslam

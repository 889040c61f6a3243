// Densities of obstructed exchanges. While two robots drive along the same two streets, their signals go
// round the same corner: seen from either, the other one appears straight behind the corner, at the detour's
// length, and unfolded like this it moves rigidly. Successive detours are therefore as consistent with each
// other as direct links are, and an alignment that takes them for direct ones is no better evidence than one
// that takes them for detours. An exchange, a range and the angles measured at the same time, has the density
//   (1 - c) / span + c p(exchange | the preceding one moved by both odometries),   c = exp(-gap / T)
// relative to uniform angles, with a mixture over the paths of both exchanges and first-order propagation of
// the range's and the angles' variances. Seen from above.
// Angles within half a second of a range belong to it; of several ranges at one time the first carries them.
#pragma once

#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

// Likelihood of a distance, given a range whose direct path is obstructed: the signal takes a detour, so that
// with an error of standard deviation s the range exceeds the distance by any length. With
// x = range - distance, the detour's density is multiplied by
//   Phi(x / s)
// which is log-concave and rejects distances that exceed the range. The excess of an exponential density
// would also pull the distance towards the range; where all links go round corners, that pull accumulates.

struct ObstructedRange {
  double probability = 1;  ///< Phi(x / s)
  double slope = 0;        ///< d log Phi / dx
  double curvature = 0;    ///< -d^2 log Phi / dx^2, in (0, 1 / s^2)
};

/// The probability alone, which costs less. Both expect sigma > 0.
double obstructed_probability(double x, double sigma);
ObstructedRange obstructed_range(double x, double sigma);

struct DetourModel {
  double span_m = 1;              ///< width of the density of a range without a preceding one
  double correlation_time_s = 1;  ///< T
  double direct_probability = 0;  ///< that one of an angle's paths is the one round the corner
};

/// Density of every range (1/m), with the angles of its exchange. `path_prior`: of all paths of all bearings,
/// in order.
template <class Pose>
std::vector<double> detour_densities(const TeamGraph<Pose>& team, const std::vector<double>& path_prior,
                                     const DetourModel& model);

}  // namespace radioslam

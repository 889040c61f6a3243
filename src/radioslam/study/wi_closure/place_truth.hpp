// Which closures between robots by their scans are true: those within 0.3 m and 3 degrees of the true
// relative pose of their keyframes, by x, y and yaw in the plane.
#pragma once

#include <cstddef>

#include "radioslam/base/units.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

inline constexpr double kTruePlace_m = 0.3;
inline constexpr double kTruePlace_rad = 3 * kRadiansPerDegree;

/// Accepted closures between robots by their scans, and those of them that are true. Closures that the truth
/// does not cover are not counted.
struct PlaceClosures {
  std::size_t accepted = 0, true_accepted = 0;
};
PlaceClosures count_place_closures(const RunResult& result, const Truth& truth);

}  // namespace radioslam

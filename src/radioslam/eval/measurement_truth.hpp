// Judges the closures of a run by their measurements: whether what was measured agrees with the truth.
//   match   relative pose within 3 sigma + 0.5 m and 3 sigma + 5 degrees of the true one; by x, y and yaw in
//           the plane. A label of the mission takes precedence.
//   range   within 3 sigma + 0.5 m of the true distance of the antennas.
//   aoa     one of its paths within 3 sigma + 5 degrees of the true direction; azimuth only if the path has
//   no
//           elevation. A label that there is no direct path makes it false.
// Closures of other kinds have no measurement in the mission; measurements to anchors are not in
// closures.csv.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Accepted and rejected closures of one kind, and those of either whose measurement is true.
struct JudgedClosures {
  std::size_t accepted = 0, true_accepted = 0, rejected = 0, true_rejected = 0;
};

/// Per kind of measurement that the run has closures of. Robots of `closures` are indices in the mission,
/// whose measurements they follow in order; `keyframes` are the run's stamps per robot. Closures that the
/// truth does not cover are not counted.
std::map<ClosureKind, JudgedClosures> judge_closures(const std::vector<ClosureResult>& closures,
                                                     const std::vector<std::vector<Stamp>>& keyframes,
                                                     const Mission& mission, const Truth& truth);

}  // namespace radioslam

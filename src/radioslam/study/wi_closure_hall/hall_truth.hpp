// Which results of a run are true: closures between robots by their scans, and the paths of angles.
//
// A closure is true within 0.3 m and 3 degrees of the true relative pose of its keyframes, by x, y and yaw in
// the plane. A path of an angle is direct by the simulator's label.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/units.hpp"
#include "radioslam/mission/mission.hpp"
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

/// An angle measurement and what a run made of its paths.
struct AnglePaths {
  std::size_t paths = 0;
  std::optional<int> direct_path;  ///< as in Truth::direct_paths
  std::vector<double> weights;     ///< posterior of each path; empty if the run did not use the angle
  bool accepted = false;

  bool has_direct() const { return direct_path && *direct_path != kNoDirectPath; }
  /// Path of the greatest weight, the first of equal ones.
  std::optional<std::size_t> likeliest() const;
  /// Whether it is the direct one, and the angle accepted.
  bool finds_direct() const;
};

/// The mission's angles between robots, in their order.
std::vector<AnglePaths> judge_angle_paths(const RunResult& result, const Mission& mission,
                                          const Truth& truth);

}  // namespace radioslam

// What a run makes of the paths of angles. A path is direct by the simulator's label.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

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
std::vector<AnglePaths> compare_angle_paths(const RunResult& result, const Mission& mission,
                                            const Truth& truth);

}  // namespace radioslam

// Stated starts against what pairs of nodes measure: whose start is wrong, or which two are exchanged.
//
// Two starts that are exchanged turn the relative pose of their robots into its inverse. Otherwise the robot
// is named that most of its pairs contradict; of two robots alone, either may be wrong.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A relative pose of two starts that contradicts the stated one.
struct StartError {
  SE3 error;  ///< T_stated_found of node j's start in node i's
  double sigma_m = 0, sigma_rad = 0;

  double distance_m() const { return error.translation().head<2>().norm(); }
  double turn_rad() const;
  bool is_far() const { return distance_m() > 3 * sigma_m || turn_rad() > 3 * sigma_rad; }
  bool agrees_with(const StartError& other) const;
};

/// What a pair measures: robots, or a robot and the common frame (the number of robots).
struct PairOfStarts {
  std::size_t i = 0, j = 0;
  std::optional<StartError> error;  ///< nothing: the stated starts agree
};

/// At most one finding. `measured`: what contradicts, "the radio links".
std::vector<Finding> start_findings(const Mission& mission, const std::vector<PairOfStarts>& pairs,
                                    const std::string& measured);

}  // namespace radioslam

// What was true. Evaluation and the report read it; no estimator takes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// One robot's true body poses T_common_body; may be sparse, may be empty.
struct RobotTruth {
  std::string id;
  Trajectory<SE3> poses;
  bool has_orientation = true;  ///< false where only positions are known (waypoints)
};

/// Says in Truth::direct_paths that none of the paths is direct.
inline constexpr int kNoDirectPath = -1;

/// True poses of the team, in the order of Mission::robots, and what is known of its measurements.
struct Truth {
  std::vector<RobotTruth> robots;
  /// Per Mission::arrivals which path is direct, or kNoDirectPath; nothing where that is not known.
  /// Empty when it is known of none.
  std::vector<std::optional<int>> direct_paths = {};
  /// Per Mission::matches whether the two places are near each other; likewise.
  std::vector<std::optional<bool>> true_matches = {};
  /// Are no poses known?
  bool empty() const {
    for (const auto& robot : robots)
      if (!robot.poses.empty()) return false;
    return true;
  }
};

}  // namespace radioslam

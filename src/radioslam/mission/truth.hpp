// Ground truth of a mission. Only evaluation and the report read it; no estimator does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// True body poses T_common_body of one robot; may be sparse or empty.
struct RobotTruth {
  std::string id;
  Trajectory<SE3> poses;
  bool has_orientation = true;  ///< false where only positions are known (waypoints)
};

/// Entry of Truth::direct_paths for a measurement without a direct path.
inline constexpr int kNoDirectPath = -1;

/// True poses of the team, in the order of Mission::robots, and labels of its measurements.
struct Truth {
  std::vector<RobotTruth> robots;
  /// Index of the direct path per Mission::aoa_measurements, or kNoDirectPath; nothing where unknown. Empty
  /// if unknown for all.
  std::vector<std::optional<int>> direct_paths = {};
  /// Per Mission::matches, whether the two places are near each other; nothing where unknown. Empty if
  /// unknown for all.
  std::vector<std::optional<bool>> true_matches = {};
  /// Whether no true poses are known.
  bool empty() const {
    for (const auto& robot : robots)
      if (!robot.poses.empty()) return false;
    return true;
  }
};

}  // namespace radioslam

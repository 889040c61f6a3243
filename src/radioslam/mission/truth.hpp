// What was true. Evaluation and the report read it; no estimator takes it.
#pragma once

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

/// True poses of the team, in the order of Mission::robots.
struct Truth {
  std::vector<RobotTruth> robots;
  bool empty() const {
    for (const auto& robot : robots)
      if (!robot.poses.empty()) return false;
    return true;
  }
};

}  // namespace radioslam

// Where each factor of the joint graph came from: which measurement, robots and keyframes.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Kind of measurement that a factor was made from.
enum class FactorSource { kOdometry, kRange, kAoa, kFingerprint, kSequence, kScanLoop, kLoop, kMatch };

struct FactorOrigin {
  FactorSource source = FactorSource::kOdometry;
  /// Index among the measurements of its source: ranges, angles of arrival and matches of the mission,
  /// proposed closures, or the robot's odometry steps.
  std::size_t measurement = 0;
  RobotIndex robot_i, robot_j;   ///< invalid for an anchor
  Stamp stamp_i, stamp_j;        ///< of the keyframes at or before both ends
  std::size_t antenna_pair = 0;  ///< of a range: index into JointGraph::antenna_pairs
};

/// The origins of a joint graph's factors: one entry per factor of each list, in the same order.
struct FactorOrigins {
  std::vector<FactorOrigin> relative_poses;  ///< of team.graph.relative_poses
  std::vector<FactorOrigin> ranges;          ///< of team.graph.ranges
  std::vector<FactorOrigin> bearings;        ///< of team.bearings
};

/// Number of factors of one source.
std::size_t count_factors(const std::vector<FactorOrigin>& origins, FactorSource source);

}  // namespace radioslam

// Intra-robot loop closure by scan matching, to be added to the joint graph as a factor.
#pragma once

#include "radioslam/base/stamp.hpp"
#include "radioslam/lidar/loops/scan_loops.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// The joint graph has nodes at both stamps.
struct ScanClosure {
  RobotIndex robot;
  Stamp stamp_i, stamp_j;
  ScanLoop loop;
};

}  // namespace radioslam

// Keyframes with scans of a robot whose odometry is used as recorded, for place recognition.
#pragma once

#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/lidar/scan_matcher.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/places/loops/scan_loop.hpp"

namespace radioslam {

/// Scanned keyframes; without an estimate of the motion between them.
struct ScansOnOdometry {
  ScanKeyframes keyframes;
  std::vector<Stamp> stamps;
};

/// Scans within the robot's odometry, `keyframes` apart, deskewed by it, in `clouds`. The nominal inlier
/// ratio is measured by registering some of them to those just before. Cost: reading and measuring the
/// keyframes' scans.
ScansOnOdometry scans_on_odometry(const Robot& robot, const ScannerTraits& traits, const LidarParams& params,
                                  const KeyframeParams& keyframes, CloudStore& clouds);

}  // namespace radioslam

// One robot's scans in a row: every scan laid onto the map of those before it (lidar/scan_odometry.hpp), and
// those that become keyframes with their clouds.
//
// Where a scan is looked for is told by the first of these that covers the time since the scan before:
//   inertial readings    where the caller has them help           (inertial_guide.hpp)
//   recorded odometry
//   the motion so far
// The same tells how the body moved while a scan was swept, recorded odometry only with rows as often as
// scans (scan_guess.hpp); how much of that is left open is part of each step's covariance (sweep_bend.hpp).
// Scans that fit nothing, or have hardly any points, are not in the row; they are counted. A first scan that
// the next ones did not fit is no place to start from: the row then begins with the new map.
// Cost: the scans' registrations; of the clouds only those of the keyframes are kept.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/lidar/scan_loops.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/scan_params.hpp"

namespace radioslam {

struct ScanTrack {
  std::vector<ScanPose> poses;  ///< those registered, without their clouds
  std::vector<std::size_t> keyframes;
  std::vector<ScanCloud> clouds;  ///< of the keyframes
  std::map<ScanOutcome, std::size_t> outcomes;
  PointCounts points;
  double usual_share = 0;
  bool is_level = false;  ///< gravity told how the first pose stands
};

/// Which readings help to lay scans.
enum class ScanGuide { kNone, kReadings };

/// The robot's first `until` scans. Keyframes are chosen by the rule of select_keyframes; the last pose is
/// one.
ScanTrack track_scans(const Robot& robot, std::size_t until, ScanGuide by, const ScannerTraits& traits,
                      const ScanParams& params, const KeyframeParams& keyframes, const Progress& progress);

/// The keyframes for the search for loops; takes the track's clouds.
ScanKeyframes take_keyframes(ScanTrack& track, const ScannerTraits& traits);

}  // namespace radioslam

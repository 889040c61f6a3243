// LiDAR(-inertial) odometry and intra-robot loop closures of all robots with laser scans.
//
// The scans' poses and their covariances become the robot's odometry. Recorded odometry initialises scan
// matching, deskews scans, and extends the odometry before, after and between them; an IMU does the first two
// better and constrains motion that the scans do not. Robots without scans stay unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_closure.hpp"
#include "radioslam/odometry/scan_params.hpp"

namespace radioslam {

struct MeasuredScans {
  std::vector<ScanClosure> closures;
  std::vector<std::string> notes;
  std::size_t scans = 0, registered = 0;
  std::size_t too_few = 0, lost = 0;  ///< skipped: too few points; no match with the map
};

/// Replaces the odometry of robots with scans; returns their closures.
MeasuredScans measure_scans(Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress);

}  // namespace radioslam

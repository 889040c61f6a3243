// Tracks a robot's scans together with its IMU, or without it if the IMU data is inconsistent with the scans.
//
//   outliers        single IMU outliers are removed                (inertial/imu_outliers.hpp)
//   consistency     of the IMU with the first `check_s` of scans   (inertial/imu_consistency.hpp)
//   tracking        all scans, with the IMU as motion prior        (scan_tracking.hpp)
//   smoothing       poses from scans and IMU together              (inertial_odometry.hpp)
//
// If the consistency test or the smoother finds a contradiction, or gravity cannot be estimated, the IMU is
// ignored with a note.
// Cost: the scans' registrations; with an IMU, those of the first `check_s` seconds twice.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_params.hpp"
#include "radioslam/odometry/scan_tracking.hpp"

namespace radioslam {

/// Removes IMU outliers from `robot`.
ScanTrajectory track_scans_with_imu(Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                                    const KeyframeParams& keyframes, const Progress& progress,
                                    std::vector<std::string>& notes);

}  // namespace radioslam

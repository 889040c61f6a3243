// Motion prior of a scan from sources other than scan matching: recorded odometry or an IMU.
#pragma once

#include <optional>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/lidar/deskew.hpp"

namespace radioslam {

struct MotionPrior {
  MotionSource source = MotionSource::kOdometry;
  std::optional<SE3> T_previous_body;  ///< since the last scan; nothing for the first
  ScanMotion scan_motion;              ///< during the sweep
};

/// From recorded odometry, interpolated between its samples. Nothing if it does not cover both the sweep and
/// the time since `previous`, the last scan's stamp, or if its samples there are more than `max_gap_s`
/// apart.
std::optional<MotionPrior> prior_from_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                               Stamp stamp, const ScanTimeSpan& time, double max_gap_s);

/// Longest time between successive samples within `begin` to `end`, including the interval at either end; the
/// trajectory covers both.
double max_sample_gap_s(const Trajectory<SE3>& samples, Stamp begin, Stamp end);

}  // namespace radioslam
